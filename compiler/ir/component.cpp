// SPDX-License-Identifier: MIT
#include "ir/component.hpp"

#include <utility>

#include "ir/build.hpp"

namespace skc::ir {
namespace {

ExprPtr ofConstruct(const Construct& n, std::uint8_t number) {
  if (n.args.size() == 1) return componentOf(*n.args.front(), number);
  std::uint8_t first = 0;
  for (const ExprPtr& arg : n.args) {
    if (number < first + arg->type.width) return componentOf(*arg, static_cast<std::uint8_t>(number - first));
    first = static_cast<std::uint8_t>(first + arg->type.width);
  }
  return nullptr;
}

/// False for products of a matrix and a vector.
bool isByComponent(const Binary& n) { return n.lhs->type.isArithmetic() && n.rhs->type.isArithmetic(); }

}  // namespace

ExprPtr componentOf(const Expr& expr, std::uint8_t number) {
  if (!expr.type.isVector()) return clone(expr);
  if (const auto* n = std::get_if<Construct>(&expr.node)) return ofConstruct(*n, number);
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) return componentOf(*n->base, n->components[number]);
  if (const auto* n = std::get_if<Unary>(&expr.node)) {
    return unary(n->op, componentOf(*n->operand, number), expr.loc);
  }
  if (const auto* n = std::get_if<Binary>(&expr.node); n != nullptr && isByComponent(*n)) {
    return binary(n->op, componentOf(*n->lhs, number), componentOf(*n->rhs, number), expr.loc);
  }
  if (const auto* n = std::get_if<Convert>(&expr.node)) {
    return convert(expr.type.scalar, componentOf(*n->operand, number), expr.loc);
  }
  return makeExpr(expr.type.component(), Swizzle{clone(expr), {number}}, expr.loc);
}

}  // namespace skc::ir
