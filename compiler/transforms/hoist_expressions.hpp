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

#include "ir/ir.hpp"
#include "support/function_ref.hpp"

namespace skc {

/// Hoists every expression for which `isHoisted` is true. If that is a `?:`, it becomes a branch itself; any other
/// expression keeps its form, and only the operators around it become branches.
void hoistExpressions(ir::Function& function, FunctionRef<bool(const ir::Expr&)> isHoisted);

}  // namespace skc
