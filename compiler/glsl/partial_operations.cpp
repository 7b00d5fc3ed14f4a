// SPDX-License-Identifier: MIT
#include "glsl/partial_operations.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "ir/evaluate.hpp"

namespace skc::emit {
namespace {

using namespace ir;

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
