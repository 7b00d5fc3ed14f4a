// SPDX-License-Identifier: MIT
//
// Conditions as guard-streams builds them: bool expressions of a kernel's Spec variables, kept short by
// rules that need no knowledge of their values.
#pragma once

#include <vector>

#include "ir/ir.hpp"

namespace skc {

bool isLiteral(const ir::Expr& condition, bool value);
/// Structural equality of expressions without calls, members and streams; others are never equal.
bool isSame(const ir::Expr& a, const ir::Expr& b);

ir::ExprPtr notOf(const ir::Expr& condition);
ir::ExprPtr andOf(const ir::Expr& a, const ir::Expr& b);
ir::ExprPtr orOf(const ir::Expr& a, const ir::Expr& b);

/// A comparison, without conversions that it does not need.
ir::ExprPtr comparison(ir::BinaryOp op, ir::ExprPtr lhs, ir::ExprPtr rhs);

/// The disjunction of all that is added to it; one that another covers is left out.
class AnyOf {
 public:
  void add(const ir::Expr& condition);
  /// Null where nothing was added, or where it is always true.
  ir::ExprPtr take();

 private:
  std::vector<ir::ExprPtr> terms_;
};

}  // namespace skc
