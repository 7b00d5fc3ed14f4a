// SPDX-License-Identifier: MIT
//
// Private to predicate: moves calls that may take long, or may not end, out of `&&`, `||` and `?:`, so that
// these may evaluate all their operands.
//
//   r = x > 0 ? rounds(x) : 1;      int chosen;
//                                   if (x > 0) chosen = rounds(x); else chosen = 1;
//                                   r = chosen;
#pragma once

#include <set>

#include "ir/ir.hpp"

namespace skc {

/// Functions that contain a data-dependent loop, or call a function that does.
std::set<ir::FunctionId> longFunctions(const ir::Module& module);

/// True if an expression calls one of these functions.
bool callsOneOf(const std::set<ir::FunctionId>& functions, const ir::Expr& expr);

void hoistCalls(ir::Function& function, const std::set<ir::FunctionId>& functions);

}  // namespace skc
