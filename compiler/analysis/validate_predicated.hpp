// SPDX-License-Identifier: MIT
//
// Checks the postcondition of predicate: the module is valid, and no control flow depends on a varying value.
#pragma once

#include <string>

#include "ir/ir.hpp"

namespace skc::analysis {

/// Returns the first violation, or an empty string.
std::string validatePredicated(const ir::Module& module);

}  // namespace skc::analysis
