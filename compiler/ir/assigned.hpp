// SPDX-License-Identifier: MIT
//
// Which variables statements change after their declaration: assignments, results of calls, and whatever a call that stands
// as a statement is given, for it may take a reference.
#pragma once

#include <vector>

#include "ir/ir.hpp"

namespace skc::ir {

/// Whether a statement of the block changes the variable.
bool assigns(const Block& block, VarId var);

/// Does the same for every variable of a function, whatever statement assigns it.
std::vector<bool> assignedVariables(const Function& function);

}  // namespace skc::ir
