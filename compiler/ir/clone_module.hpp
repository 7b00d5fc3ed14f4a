// SPDX-License-Identifier: MIT
//
// A deep copy of a module, for a back end that rewrites the module for itself.
#pragma once

#include "ir/ir.hpp"

namespace skc::ir {

Module clone(const Module& module);

}  // namespace skc::ir
