// SPDX-License-Identifier: MIT
//
// Private to the transforms: turns the `&&`, `||` and `?:` around chosen expressions into branches, so that each is still
// evaluated only where it was.
//
//   r = x > 0 ? f(x) : 1;      int chosen;
//                              if (x > 0) chosen = f(x); else chosen = 1;
//                              r = chosen;
//
// The condition of a loop moves into its body, and that of a `do` loop into the step of a `for` loop.
#pragma once

#include <set>

#include "ir/ir.hpp"
#include "support/function_ref.hpp"

namespace skc {

/// Hoists every expression for which `isHoisted` is true. If that is a `?:`, it becomes a branch itself; any other
/// expression keeps its form, and only the operators around it become branches.
void hoistExpressions(ir::Function& function, FunctionRef<bool(const ir::Expr&)> isHoisted);

/// Functions that contain a data-dependent loop, or call a function that does.
std::set<ir::FunctionId> longFunctions(const ir::Module& module);

/// True if an expression calls one of these functions.
bool callsOneOf(const std::set<ir::FunctionId>& functions, const ir::Expr& expr);

/// Hoists the calls of these functions. predicate does so with those that may take long, or may not end: the operators around
/// them may then evaluate all their operands.
void hoistCalls(ir::Function& function, const std::set<ir::FunctionId>& functions);

}  // namespace skc
