// SPDX-License-Identifier: MIT
#include "glsl/known_values.hpp"

#include <algorithm>
#include <bit>

#include "ir/walk.hpp"

namespace skc::emit {
namespace {

using namespace ir;

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

bool isUnknown(const Expr& expr) {
  bool is = false;
  walkExprs(expr, [&](const Expr& inner) {
    is = is || std::holds_alternative<IndexOf>(inner.node) ||
         std::holds_alternative<GatherRead>(inner.node) || std::holds_alternative<NeighborRead>(inner.node) ||
         isFloatOrVector(inner.type);
  });
  return is;
}

bool isLiteralZero(const Expr& expr) {
  const auto* n = std::get_if<Literal>(&expr.node);
  return n != nullptr && std::bit_cast<float>(n->bits) == 0;
}

bool comparesWholeWithZero(BinaryOp op, const Expr& lhs, const Expr& rhs) {
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

}  // namespace skc::emit
