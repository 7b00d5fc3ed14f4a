// SPDX-License-Identifier: MIT
//
// Floating-point literals. Clang gives `0.1` a double that it casts to float at once
// (-cl-single-precision-constant), so that `x * 0.1` is float for a float x. A formula of nothing but such
// literals takes its precision from its place: where it becomes a double, or meets one, it never was float.
//
//   double d = 0.1;              the nearest double
//   d *= 1.0 / 3.0;              divided in double
//   double e = 0.1f;             a float: its author said so
//   float f = 0.1;               rounded once, from the text
#include <algorithm>

#include <clang/AST/ASTContext.h>
#include <clang/AST/ExprCXX.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Lexer.h>
#include <llvm/ADT/APFloat.h>

#include "frontend/clang_loc.hpp"
#include "frontend/function_lowering.hpp"
#include "ir/build.hpp"

namespace skc::frontend {

using ir::ExprPtr;

namespace {

/// The literal's digits, without suffix.
std::string digitsOf(std::string text) {
  std::erase(text, '\'');
  const bool isHex = text.starts_with("0x") || text.starts_with("0X");
  while (!text.empty() &&
         (text.back() == 'f' || text.back() == 'F' || text.back() == 'l' || text.back() == 'L')) {
    if (isHex && text.find_first_of("pP") == std::string::npos) break;
    text.pop_back();
  }
  return text;
}

/// Looks through what changes nothing, and through the cast that makes a float of a literal.
const clang::Expr* bare(const clang::Expr* e) {
  while (true) {
    e = e->IgnoreParens();
    const auto* cast = llvm::dyn_cast<clang::ImplicitCastExpr>(e);
    const bool isOfLiteral = cast && (cast->getCastKind() == clang::CK_FloatingCast ||
                                      cast->getCastKind() == clang::CK_IntegralToFloating);
    if (const auto* constant = llvm::dyn_cast<clang::ConstantExpr>(e)) {
      e = constant->getSubExpr();
    } else if (isOfLiteral) {
      e = cast->getSubExpr();
    } else {
      return e;
    }
  }
}

bool isArithmetic(clang::BinaryOperatorKind kind) {
  return kind == clang::BO_Add || kind == clang::BO_Sub || kind == clang::BO_Mul || kind == clang::BO_Div;
}

bool isSign(clang::UnaryOperatorKind kind) { return kind == clang::UO_Plus || kind == clang::UO_Minus; }

}  // namespace

/// From the text where it can be read: through double, a literal of float could be rounded twice.
llvm::APFloat FunctionLowering::literalValue(const clang::FloatingLiteral* e,
                                             const llvm::fltSemantics& semantics) {
  llvm::SmallString<32> buffer;
  const clang::SourceLocation spelled = module_.sources().getSpellingLoc(e->getLocation());
  const std::string text = digitsOf(
      clang::Lexer::getSpelling(spelled, buffer, module_.sources(), module_.context().getLangOpts()).str());
  llvm::APFloat direct(semantics);
  auto status = direct.convertFromString(text, llvm::APFloat::rmNearestTiesToEven);
  if (!status) {
    llvm::consumeError(status.takeError());
    llvm::APFloat rounded = e->getValue();
    bool inexact = false;
    rounded.convert(semantics, llvm::APFloat::rmNearestTiesToEven, &inexact);
    return rounded;
  }
  const bool isFloat = &semantics == &llvm::APFloat::IEEEsingle();   // of a double, Clang tells
  if (isFloat && (*status & (llvm::APFloat::opOverflow | llvm::APFloat::opUnderflow))) {
    module_.diagnostics().report(Diag::LiteralRange, locOf(e->getLocation()),
                                 {text, direct.isInfinity() ? "infinity"
                                        : direct.isZero()   ? "0"
                                                            : "a denormal"});
  }
  return direct;
}

ExprPtr FunctionLowering::VisitFloatingLiteral(const clang::FloatingLiteral* e) {
  const llvm::APFloat value = literalValue(e, llvm::APFloat::IEEEsingle());
  return literal(ir::Type::of(ir::Scalar::Float),
                 static_cast<std::uint32_t>(value.bitcastToAPInt().getZExtValue()), e->getLocation());
}

ExprPtr FunctionLowering::doubleLiteral(const clang::FloatingLiteral* e) {
  const llvm::APFloat value = literalValue(e, llvm::APFloat::IEEEdouble());
  return ir::literal(value.convertToDouble(), module_.loc(e->getLocation()));
}

bool FunctionLowering::isLiterals(const clang::Expr* e) {
  e = bare(e);
  if (const auto* literal = llvm::dyn_cast<clang::FloatingLiteral>(e))
    return !literal->getType()->isSpecificBuiltinType(clang::BuiltinType::Float);
  if (llvm::isa<clang::IntegerLiteral>(e)) return true;
  if (const auto* sign = llvm::dyn_cast<clang::UnaryOperator>(e))
    return isSign(sign->getOpcode()) && isLiterals(sign->getSubExpr());
  if (const auto* operation = llvm::dyn_cast<clang::BinaryOperator>(e)) {
    return operation->getType()->isFloatingType() && isArithmetic(operation->getOpcode()) &&
           isLiterals(operation->getLHS()) && isLiterals(operation->getRHS());
  }
  const auto* choice = llvm::dyn_cast<clang::ConditionalOperator>(e);
  return choice && choice->getType()->isFloatingType() && isLiterals(choice->getTrueExpr()) &&
         isLiterals(choice->getFalseExpr());
}

/// Of a formula that isLiterals() holds for.
ExprPtr FunctionLowering::literalsAsDouble(const clang::Expr* e) {
  const Level level(depth_);
  checkDepth(e->getExprLoc());
  e = bare(e);
  if (const auto* literal = llvm::dyn_cast<clang::FloatingLiteral>(e)) return doubleLiteral(literal);
  if (const auto* sign = llvm::dyn_cast<clang::UnaryOperator>(e)) {
    ExprPtr operand = literalsAsDouble(sign->getSubExpr());
    if (sign->getOpcode() == clang::UO_Plus) return operand;
    if (auto* literal = std::get_if<ir::Literal>(&operand->node)) {
      literal->high ^= 0x80000000u;
      return operand;
    }
    return ir::unary(ir::UnaryOp::Negate, std::move(operand), module_.loc(sign->getOperatorLoc()));
  }
  if (const auto* operation = llvm::dyn_cast<clang::BinaryOperator>(e)) {
    const clang::BinaryOperatorKind kind = operation->getOpcode();
    const ir::BinaryOp op = kind == clang::BO_Add   ? ir::BinaryOp::Add
                            : kind == clang::BO_Sub ? ir::BinaryOp::Sub
                            : kind == clang::BO_Mul ? ir::BinaryOp::Mul
                                                    : ir::BinaryOp::Div;
    ExprPtr lhs = literalsAsDouble(operation->getLHS());
    return ir::binary(op, std::move(lhs), literalsAsDouble(operation->getRHS()),
                      module_.loc(operation->getOperatorLoc()));
  }
  if (const auto* choice = llvm::dyn_cast<clang::ConditionalOperator>(e)) {
    ExprPtr cond = condition(choice->getCond());
    ExprPtr yes = literalsAsDouble(choice->getTrueExpr());
    return select(std::move(cond), std::move(yes), literalsAsDouble(choice->getFalseExpr()),
                  choice->getQuestionLoc());
  }
  return convert(value(e), ir::Scalar::Double);   // an integer
}

/// What becomes a double.
ExprPtr FunctionLowering::doubleValue(const clang::Expr* e) {
  return isLiterals(e) ? literalsAsDouble(e) : convert(value(e), ir::Scalar::Double);
}

}  // namespace skc::frontend
