// SPDX-License-Identifier: MIT
//
// Private to validate: the rules of expressions, apart from those of statements and declarations.
#pragma once

#include <string>
#include <vector>

#include "ir/validate.hpp"

namespace skc::ir {

/// Thrown by a rule that does not hold; validate() turns it into its result.
struct Violation {
  std::string text;
};

void require(bool holds, const std::string& text);

/// What an expression may refer to.
struct ExprContext {
  const Module& module;
  Stage stage;
  const Function* function = nullptr;        ///< null: a constant expression
  const std::vector<bool>* visible = nullptr; ///< per variable of the function
  const Kernel* kernel = nullptr;            ///< Specialized: the kernel that owns the function
  std::size_t constantLimit = 0;             ///< constants below this one may be named
};

void checkType(const Module& module, Type type);
void checkExpr(const ExprContext& context, const Expr& expr);
/// What Push (rank 0) and Scatter write to, and the type of what they write.
void checkAppendOutput(const ExprContext& context, StreamRef stream, Type value, std::uint8_t rank);
/// An expression that may be assigned to; returns the variable at its root.
VarId checkPlace(const ExprContext& context, const Expr& expr);
/// Arguments against the callee's parameters; InOut ones only where `allowInOut`.
void checkArguments(const ExprContext& context, FunctionId callee, const std::vector<ExprPtr>& args,
                    bool allowInOut);
void checkBinary(BinaryOp op, Type lhs, Type rhs, Type result);

}  // namespace skc::ir
