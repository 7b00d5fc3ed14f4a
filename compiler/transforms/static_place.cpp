// SPDX-License-Identifier: MIT
#include "transforms/static_place.hpp"

#include <variant>

namespace skc {

using namespace ir;

unsigned StaticPlace::mask() const {
  unsigned mask = 0;
  for (const std::uint8_t component : components) mask |= 1U << component;
  return mask;
}

std::optional<StaticPlace> staticPlace(const Expr& expr) {
  StaticPlace place{};
  const Expr* base = &expr;
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    place.components = n->components;
    base = n->base.get();
  } else {
    for (std::uint8_t i = 0; i < expr.type.width; ++i) place.components.push_back(i);
  }
  place.type = base->type;
  while (const auto* n = std::get_if<Member>(&base->node)) {
    place.members.insert(place.members.begin(), n->field);
    base = n->base.get();
  }
  const auto* root = std::get_if<VarRef>(&base->node);
  if (root == nullptr) return std::nullopt;
  place.root = root->var;
  return place;
}

}  // namespace skc
