// SPDX-License-Identifier: MIT
//
// Conditions as guard-streams builds them: bool expressions of a kernel's Spec variables, simplified by rules
// that need no knowledge of their values.
#pragma once

#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// True if `expr` consists of literals, constants and variables that `isSpec` marks.
bool isSpecOnly(const ir::Expr& expr, const std::vector<bool>& isSpec);

/// Whether a condition has more parts than a person would read; such a condition is dropped.
bool isTooLong(const ir::Expr& condition);
bool isLiteral(const ir::Expr& condition, bool value);
/// Structural equality of expressions without calls, members and streams; others are never equal.
bool isSame(const ir::Expr& a, const ir::Expr& b);

ir::ExprPtr notOf(const ir::Expr& condition);
ir::ExprPtr andOf(const ir::Expr& a, const ir::Expr& b);
ir::ExprPtr orOf(const ir::Expr& a, const ir::Expr& b);

/// `condition ? yes : no`. A choice of bools has no Select, so that it may be a condition.
ir::ExprPtr choiceOf(const ir::Expr& condition, const ir::Expr& yes, const ir::Expr& no);

/// Builds a comparison, dropping conversions that it does not need.
ir::ExprPtr comparison(ir::BinaryOp op, ir::ExprPtr lhs, ir::ExprPtr rhs);

/// Builds a disjunction, leaving out conditions that another one covers.
class AnyOf {
 public:
  void add(const ir::Expr& condition);
  /// Returns null if nothing was added, or if it is always true.
  ir::ExprPtr take();

 private:
  std::vector<ir::ExprPtr> terms_;
};

}  // namespace skc
