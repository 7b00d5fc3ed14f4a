// SPDX-License-Identifier: MIT
//
// Private to validate: the rules for expressions, separate from those for statements and declarations.
#pragma once

#include <string>
#include <vector>

#include "ir/validate.hpp"

namespace skc::ir {

/// Thrown when a rule is violated; validate() turns it into its result.
struct Violation {
  std::string text;
};

void require(bool holds, const std::string& text);

/// What an expression may refer to.
struct ExprContext {
  const Module& module;
  Stage stage;
  const Function* function = nullptr;        ///< null: a constant expression
  const std::vector<bool>* visible = nullptr; ///< one per variable of the function
  const Kernel* kernel = nullptr;            ///< Specialized: the kernel that owns the function
  std::size_t constantLimit = 0;             ///< only constants below this one may be named
};

void checkType(const Module& module, Type type);
void checkExpr(const ExprContext& context, const Expr& expr);
/// Checks the target of a Push (rank 0) or a Scatter, and the type of the value.
void checkAppendOutput(const ExprContext& context, StreamRef stream, Type value, std::uint8_t rank);
/// Checks that the expression is an lvalue; returns the variable at its root.
VarId checkLValue(const ExprContext& context, const Expr& expr);
/// Checks arguments against the callee's parameters; InOut parameters need `allowInOut`, and their arguments must
/// neither overlap, with the result's lvalue (or null) either, nor have an index that the call changes.
void checkArguments(const ExprContext& context, FunctionId callee, const std::vector<ExprPtr>& args,
                    bool allowInOut, const Expr* result = nullptr);
void checkBinary(BinaryOp op, Type lhs, Type rhs, Type result);

}  // namespace skc::ir
