// SPDX-License-Identifier: MIT
//
// Expressions that name an object: an lvalue, a constant, an element of a gather, a choice of two such expressions, or a part of one. The IR has no
// choice of lvalues; what writes to one becomes a branch:
//
//   (c ? a : b[i]).x = 3;     ->     if (c) a.x = 3; else b[i].x = 3;
#pragma once

#include <vector>

#include "ir/ir.hpp"

namespace skc::frontend {

bool isLocation(const ir::Expr& e);
/// True for a location that never names a constant or an element of a gather.
bool isWritable(const ir::Expr& e);

/// The variables that a location may name or be a part of, in ascending order.
std::vector<ir::VarId> rootsOf(const ir::Expr& location);

/// The outermost choice in a location; null if there is none.
ir::Select* choiceIn(ir::Expr& location);

/// Replaces the outermost choice in a location by one of its sides.
void choose(ir::ExprPtr& location, bool yes);

}  // namespace skc::frontend
