// SPDX-License-Identifier: MIT
//
// From the condition that guard-streams has found to the steps that the runtime follows.
#pragma once

#include <vector>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

std::vector<sk::program::ConditionStep> conditionSteps(const ir::Kernel& kernel, const ir::Expr& condition);

}  // namespace skc::emit
