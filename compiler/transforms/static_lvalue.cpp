// SPDX-License-Identifier: MIT
#include "transforms/static_lvalue.hpp"

#include <variant>

namespace skc {

using namespace ir;

unsigned StaticLValue::mask() const {
  unsigned mask = 0;
  for (const std::uint8_t component : components) mask |= 1U << component;
  return mask;
}

std::optional<StaticLValue> staticLValue(const Expr& expr) {
  StaticLValue lvalue{};
  const Expr* base = &expr;
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    lvalue.components = n->components;
    base = n->base.get();
  } else {
    for (std::uint8_t i = 0; i < expr.type.width; ++i) lvalue.components.push_back(i);
  }
  lvalue.type = base->type;
  while (const auto* n = std::get_if<Member>(&base->node)) {
    lvalue.members.insert(lvalue.members.begin(), n->field);
    base = n->base.get();
  }
  const auto* root = std::get_if<VarRef>(&base->node);
  if (root == nullptr) return std::nullopt;
  lvalue.root = root->var;
  return lvalue;
}

}  // namespace skc
