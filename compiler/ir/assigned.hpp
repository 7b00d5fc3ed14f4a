// SPDX-License-Identifier: MIT
//
// Finds the variables that statements change after their declaration: by assignments, as results of calls,
// and as arguments of CallStmts, whose parameters may be references.
#pragma once

#include <vector>

#include "ir/ir.hpp"

namespace skc::ir {

/// True if a statement of the block changes the variable.
bool assigns(const Block& block, VarId var);

/// The variables that the block's statements change, each once.
std::vector<VarId> assignedIn(const Block& block);

/// For each variable of the function, whether any of its statements changes it.
std::vector<bool> assignedVariables(const Function& function);

}  // namespace skc::ir
