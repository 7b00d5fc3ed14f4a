// SPDX-License-Identifier: MIT
//
// Checks what predicate promises: a valid module, in which no control flow depends on a value that varies.
#pragma once

#include <string>

#include "ir/ir.hpp"

namespace skc::analysis {

/// The first violation found; empty if there is none.
std::string validatePredicated(const ir::Module& module);

}  // namespace skc::analysis
