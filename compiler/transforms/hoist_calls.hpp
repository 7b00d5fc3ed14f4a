// SPDX-License-Identifier: MIT
//
// Private to predicate: takes calls that may take long, or forever, out of `&&`, `||` and `?:`, so that these may be
// evaluated in full.
//
//   r = x > 0 ? rounds(x) : 1;      int chosen;
//                                   if (x > 0) chosen = rounds(x); else chosen = 1;
//                                   r = chosen;
#pragma once

#include <set>

#include "ir/ir.hpp"

namespace skc {

/// Functions with a loop whose trip count depends on data, or that call one.
std::set<ir::FunctionId> longFunctions(const ir::Module& module);

/// Whether an expression calls one of these functions.
bool callsOneOf(const std::set<ir::FunctionId>& functions, const ir::Expr& expr);

void hoistCalls(ir::Function& function, const std::set<ir::FunctionId>& functions);

}  // namespace skc
