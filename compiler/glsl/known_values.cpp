// SPDX-License-Identifier: MIT
#include "glsl/known_values.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "ir/evaluate.hpp"
#include "ir/walk.hpp"

namespace skc::emit {

using namespace ir;

namespace {

bool isFloatOrVector(Type type) {
  return (type.isScalar() || type.isVector()) && arithmeticScalar(type.scalar) == Scalar::Float;
}

/// True unless the value of a constant is made of literals other than 0.
bool mayHoldZero(const Expr& value) {
  if (const auto* n = std::get_if<Literal>(&value.node)) return value.type.isFloat() && isZero(n->bits);
  if (const auto* n = std::get_if<Unary>(&value.node)) return mayHoldZero(*n->operand);
  const auto* n = std::get_if<Construct>(&value.node);
  return n == nullptr || std::ranges::any_of(n->args, [](const ExprPtr& arg) { return mayHoldZero(*arg); });
}

/// True if 1 / x is a float that is not denormal, for the float with these bits.
bool hasExactReciprocal(std::uint32_t bits) {
  const std::uint32_t exponent = bits >> 23U & 0xffU;
  return (bits & 0x7fffffU) == 0 && exponent > 0 && exponent < 0xfeU;
}

/// True for a parameter of the kernel, whose value only the running program has.
bool isGiven(const Module& module, const Kernel& kernel, FunctionId function, VarId var) {
  if (function != kernel.entry || var >= module.functions[function].parameterCount) return false;
  const ParamRole role = kernel.params[var].role;
  return role == ParamRole::Input || role == ParamRole::Uniform;
}

}  // namespace

bool isZero(std::uint32_t bits) { return std::bit_cast<float>(bits) == 0; }

bool isLiteral(const Expr& expr) {
  if (const auto* n = std::get_if<Construct>(&expr.node))
    return std::ranges::all_of(n->args, [](const ExprPtr& arg) { return isLiteral(*arg); });
  return std::holds_alternative<Literal>(expr.node);
}

bool mayBeKnownZero(const Module& module, const Expr& expr) {
  if (!isFloatOrVector(expr.type)) return false;
  const Expr* whole = &expr;
  do {
    if (const auto* constant = std::get_if<ConstantRef>(&whole->node))
      return mayHoldZero(*module.constants[constant->constant].value);
    if (const auto* member = std::get_if<Member>(&whole->node)) {
      whole = member->base.get();
    } else if (const auto* element = std::get_if<Index>(&whole->node)) {
      whole = element->base.get();
    } else {
      return false;
    }
  } while (!isFloatOrVector(whole->type));
  return false;  // the whole has been hidden
}

bool mayBeKnownDivisor(const Module& module, const Kernel& kernel, FunctionId function, const Expr& expr) {
  if (!isFloatOrVector(expr.type)) return false;
  const auto any = [&](const std::vector<ExprPtr>& parts) {
    return std::ranges::any_of(
        parts, [&](const ExprPtr& part) { return mayBeKnownDivisor(module, kernel, function, *part); });
  };
  if (const auto* n = std::get_if<Literal>(&expr.node)) return !hasExactReciprocal(n->bits);
  if (const auto* n = std::get_if<VarRef>(&expr.node)) return !isGiven(module, kernel, function, n->var);
  if (const auto* n = std::get_if<Construct>(&expr.node)) return any(n->args);
  if (const auto* n = std::get_if<IntrinsicCall>(&expr.node)) return any(n->args);
  if (const auto* n = std::get_if<Unary>(&expr.node))
    return mayBeKnownDivisor(module, kernel, function, *n->operand);
  if (const auto* n = std::get_if<Swizzle>(&expr.node))
    return mayBeKnownDivisor(module, kernel, function, *n->base);
  if (const auto* n = std::get_if<Select>(&expr.node))
    return mayBeKnownDivisor(module, kernel, function, *n->yes) ||
           mayBeKnownDivisor(module, kernel, function, *n->no);
  return std::holds_alternative<ConstantRef>(expr.node) || std::holds_alternative<Call>(expr.node) ||
         std::holds_alternative<Member>(expr.node) || std::holds_alternative<Index>(expr.node);
}

bool mayCancel(Intrinsic intrinsic) { return intrinsic == Intrinsic::Sqrt || intrinsic == Intrinsic::Ldexp; }

bool isUnknown(const Expr& expr) {
  bool is = false;
  walkExprs(expr, [&](const Expr& inner) {
    is = is || std::holds_alternative<IndexOf>(inner.node) ||
         std::holds_alternative<GatherRead>(inner.node) || std::holds_alternative<NeighborRead>(inner.node) ||
         isFloatOrVector(inner.type);
  });
  return is;
}

bool isNonNegative(const Expr& expr) {
  const auto* n = std::get_if<Literal>(&expr.node);
  return n != nullptr && static_cast<std::int32_t>(n->bits) >= 0;
}

bool isLiteralZero(const Expr& expr) {
  const auto* n = std::get_if<Literal>(&expr.node);
  return n != nullptr && std::bit_cast<float>(n->bits) == 0;
}

bool comparesRoundedWithZero(BinaryOp op, const Expr& lhs, const Expr& rhs) {
  const bool isEquality = op == BinaryOp::Equal || op == BinaryOp::NotEqual;
  if (!isEquality || !lhs.type.isScalar() || !isFloatOrVector(lhs.type) ||
      !(isLiteralZero(lhs) || isLiteralZero(rhs)))
    return false;
  bool isWhole = false;
  walkExprs(isLiteralZero(lhs) ? rhs : lhs, [&](const Expr& expr) {
    const auto* n = std::get_if<IntrinsicCall>(&expr.node);
    isWhole =
        isWhole || (n != nullptr && (n->intrinsic == Intrinsic::Floor || n->intrinsic == Intrinsic::Ceil));
  });
  return isWhole;
}

namespace {

/// True if every component of a value is a known constant that satisfies the predicate.
template <class Predicate>
bool isKnown(const Module& module, const Expr& expr, Predicate isGood) {
  if (const auto bits = evaluateInFloat(module, expr, Constants::LookThrough)) return isGood(*bits);
  if (const auto* n = std::get_if<ConstantRef>(&expr.node)) {
    return isKnown(module, *module.constants[n->constant].value, isGood);
  }
  const auto* n = std::get_if<Construct>(&expr.node);
  return n != nullptr && expr.type.isVector() &&
         std::ranges::all_of(n->args, [&](const ExprPtr& arg) { return isKnown(module, *arg, isGood); });
}

bool isBelow32(std::uint32_t bits) { return bits < 32; }

}  // namespace

bool mayDivideBadly(const Module& module, BinaryOp op, const Expr& lhs, const Expr& rhs) {
  if ((op != BinaryOp::Div && op != BinaryOp::Rem) || !lhs.type.arithmeticType().isInteger()) return false;
  const bool isInt = arithmeticScalar(lhs.type.scalar) == Scalar::Int;
  return !isKnown(module, rhs,
                  [&](std::uint32_t bits) { return bits != 0 && !(isInt && bits == 0xffffffffU); });
}

bool mayShiftTooFar(const Module& module, BinaryOp op, const Expr& count) {
  if (op != BinaryOp::ShiftLeft && op != BinaryOp::ShiftRight) return false;
  if (const auto* n = std::get_if<Binary>(&count.node); n != nullptr && n->op == BinaryOp::BitAnd) {
    if (isKnown(module, *n->lhs, isBelow32) || isKnown(module, *n->rhs, isBelow32)) return false;
  }
  return !isKnown(module, count, isBelow32);
}

bool mayNotHold(const Module& module, Type to, const Expr& operand) {
  const Scalar from = operand.type.scalar;
  if (!to.arithmeticType().isInteger() || arithmeticScalar(from) != Scalar::Float) return false;
  if (from == Scalar::Unorm8 || from == Scalar::Unorm16) return false;
  const bool isInt = arithmeticScalar(to.scalar) == Scalar::Int;
  if (isInt && (from == Scalar::Snorm8 || from == Scalar::Snorm16)) return false;
  return !isKnown(module, operand, [&](std::uint32_t bits) {
    const auto value = std::bit_cast<float>(bits);
    return isInt ? value >= -0x1p31F && value < 0x1p31F : value >= 0 && value < 0x1p32F;
  });
}

}  // namespace skc::emit
