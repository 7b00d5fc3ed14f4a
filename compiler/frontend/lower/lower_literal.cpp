// SPDX-License-Identifier: MIT
//
// Floating-point literals. For Clang, `0.1` is a float (float_literals.hpp), so that `x * 0.1` is float for a
// float x. The precision of an expression of such literals only depends on its context: if it is converted to
// double, or meets a double, its literals are read as doubles from their text.
//
//   double d = 0.1;              the nearest double
//   d *= 1.0 / 3.0;              divided in double
//   d += 1 / 3;                  0: integers keep C++'s meaning
//   double e = 0.1f;             a float, as written
//   float f = 0.1;               rounded once, from the text
#include <algorithm>

#include <clang/AST/ASTContext.h>
#include <clang/AST/ExprCXX.h>
#include <clang/Basic/SourceManager.h>
#include <clang/Lex/Lexer.h>
#include <llvm/ADT/APFloat.h>

#include "frontend/clang_loc.hpp"
#include "frontend/lower/function_lowering.hpp"
#include "ir/build.hpp"

namespace skc::frontend {

using ir::ExprPtr;

namespace {

/// Skips nodes without effect on the value, and the cast to float of an integer or of `0.1L`.
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

/// True for a formula of nothing but integer literals, which C++ computes in integers: `1 / 2` is 0, `-1u` is 4294967295.
bool isIntegerFormula(const clang::Expr* e) {
  e = e->IgnoreParenImpCasts();
  if (!e->getType()->isIntegerType()) return false;
  if (llvm::isa<clang::IntegerLiteral>(e)) return true;
  if (const auto* sign = llvm::dyn_cast<clang::UnaryOperator>(e)) {
    return (isSign(sign->getOpcode()) || sign->getOpcode() == clang::UO_Not) &&
           isIntegerFormula(sign->getSubExpr());
  }
  const auto* operation = llvm::dyn_cast<clang::BinaryOperator>(e);
  return operation &&
         (operation->isAdditiveOp() || operation->isMultiplicativeOp() || operation->isBitwiseOp() ||
          operation->isShiftOp()) &&
         isIntegerFormula(operation->getLHS()) && isIntegerFormula(operation->getRHS());
}

}  // namespace

/// The literal as written in the source.
LiteralParts FunctionLowering::partsOf(const clang::FloatingLiteral* e) const {
  llvm::SmallString<32> buffer;
  const clang::SourceLocation spelled = module_.sources().getSpellingLoc(e->getLocation());
  return literalParts(
      clang::Lexer::getSpelling(spelled, buffer, module_.sources(), module_.context().getLangOpts()).str());
}

/// Reads the text if possible, because converting from another type could round twice.
llvm::APFloat FunctionLowering::literalValue(const clang::FloatingLiteral* e,
                                             const llvm::fltSemantics& semantics, std::string_view type) {
  const std::string digits = partsOf(e).digits;
  llvm::APFloat direct(semantics);
  auto status = direct.convertFromString(digits, llvm::APFloat::rmNearestTiesToEven);
  if (!status) {
    llvm::consumeError(status.takeError());
    llvm::APFloat rounded = e->getValue();
    bool inexact = false;
    rounded.convert(semantics, llvm::APFloat::rmNearestTiesToEven, &inexact);
    return rounded;
  }
  if (*status & (llvm::APFloat::opOverflow | llvm::APFloat::opUnderflow)) {
    module_.diagnostics().report(Diag::LiteralRange, locOf(e->getLocation()),
                                 {digits, type,
                                  direct.isInfinity() ? "infinity"
                                  : direct.isZero()   ? "0"
                                                      : "a denormal"});
  }
  return direct;
}

ExprPtr FunctionLowering::VisitFloatingLiteral(const clang::FloatingLiteral* e) {
  const float value = literalValue(e, llvm::APFloat::IEEEsingle(), "float").convertToFloat();
  const Loc loc = module_.loc(e->getLocation());
  if (!isOfContext(e)) return ir::literal(value, loc);
  return ir::literal(value, textValue(e), loc);
}

ExprPtr FunctionLowering::doubleLiteral(const clang::FloatingLiteral* e) {
  const llvm::APFloat value = literalValue(e, llvm::APFloat::IEEEdouble(), "double");
  return ir::literal(value.convertToDouble(), module_.loc(e->getLocation()));
}

/// True unless the literal has the suffix of floats.
bool FunctionLowering::isOfContext(const clang::FloatingLiteral* e) const {
  const std::string suffix(partsOf(e).suffix);
  return suffix != "f" && suffix != "F";
}

/// The double nearest to the literal's text.
double FunctionLowering::textValue(const clang::FloatingLiteral* e) const {
  llvm::APFloat value(llvm::APFloat::IEEEdouble());
  auto status = value.convertFromString(partsOf(e).digits, llvm::APFloat::rmNearestTiesToEven);
  if (!status) {
    llvm::consumeError(status.takeError());
    bool inexact = false;
    value = e->getValue();
    value.convert(llvm::APFloat::IEEEdouble(), llvm::APFloat::rmNearestTiesToEven, &inexact);
  }
  return value.convertToDouble();
}

bool FunctionLowering::isLiterals(const clang::Expr* e) const {
  e = bare(e);
  if (const auto* literal = llvm::dyn_cast<clang::FloatingLiteral>(e)) {
    return isOfContext(literal);
  }
  if (e->getType()->isIntegerType()) return isIntegerFormula(e);
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

/// Lowers an expression for which isLiterals() is true.
ExprPtr FunctionLowering::literalsAsDouble(const clang::Expr* e) {
  const Level level(depth_);
  checkDepth(e->getExprLoc());
  e = bare(e);
  if (e->getType()->isIntegerType()) {  // computed in integers, and then converted
    if (const std::optional<double> number = integerValue(e))
      return ir::literal(*number, module_.loc(e->getExprLoc()));
    return convert(value(e), ir::Scalar::Double);
  }
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
  const auto* choice = llvm::cast<clang::ConditionalOperator>(e);
  ExprPtr cond = condition(choice->getCond());
  ExprPtr yes = literalsAsDouble(choice->getTrueExpr());
  return select(std::move(cond), std::move(yes), literalsAsDouble(choice->getFalseExpr()),
                choice->getQuestionLoc());
}

/// Lowers an expression that is converted to double.
ExprPtr FunctionLowering::doubleValue(const clang::Expr* e) {
  return isLiterals(e) ? literalsAsDouble(e) : convert(value(e), ir::Scalar::Double);
}

}  // namespace skc::frontend
