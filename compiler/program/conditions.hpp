// SPDX-License-Identifier: MIT
//
// Translates the conditions found by guard-streams to the steps that the runtime evaluates.
#pragma once

#include <vector>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

std::vector<sk::program::ConditionStep> conditionSteps(const ir::Kernel& kernel, const ir::Expr& condition);

}  // namespace skc::emit
