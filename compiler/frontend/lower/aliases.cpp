// SPDX-License-Identifier: MIT
#include "frontend/lower/aliases.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace skc::frontend {
namespace {

/// True for the same member, or an element at the same literal or unchanged index.
bool isSameStep(const ir::Expr& a, const ir::Expr& b) {
  const auto* first = std::get_if<ir::Member>(&a.node);
  const auto* second = std::get_if<ir::Member>(&b.node);
  if (first != nullptr && second != nullptr) return first->field == second->field;
  const auto* left = std::get_if<ir::Index>(&a.node);
  const auto* right = std::get_if<ir::Index>(&b.node);
  if (left == nullptr || right == nullptr) return false;
  const auto* leftLiteral = std::get_if<ir::Literal>(&left->index->node);
  const auto* rightLiteral = std::get_if<ir::Literal>(&right->index->node);
  if (leftLiteral != nullptr && rightLiteral != nullptr) return leftLiteral->bits == rightLiteral->bits;
  const auto* leftVariable = std::get_if<ir::VarRef>(&left->index->node);
  const auto* rightVariable = std::get_if<ir::VarRef>(&right->index->node);
  return leftVariable != nullptr && rightVariable != nullptr && leftVariable->var == rightVariable->var;
}

}  // namespace

std::string Aliases::key() const {
  std::string key;
  for (const auto& [parameter, alias] : parts) {
    key += fmt::format("{}={}/{}", parameter, alias.whole, alias.indices);
    for (const AliasStep& step : alias.steps)
      key += fmt::format(".{}:{}", static_cast<int>(step.kind), step.value);
    key += ' ';
  }
  for (const auto* types : {&wholes, &indices}) {
    for (const auto& [parameter, type] : *types) {
      key += fmt::format("{}:{}:{}:{}:{} ", parameter, static_cast<int>(type.kind),
                         static_cast<int>(type.scalar), static_cast<int>(type.width), type.index);
    }
    key += '|';
  }
  return key;
}

std::vector<const ir::Expr*> chainOf(const ir::Expr& lvalue) {
  std::vector<const ir::Expr*> chain;
  const ir::Expr* e = &lvalue;
  while (!std::holds_alternative<ir::VarRef>(e->node)) {
    chain.push_back(e);
    if (const auto* member = std::get_if<ir::Member>(&e->node)) {
      e = member->base.get();
    } else if (const auto* index = std::get_if<ir::Index>(&e->node)) {
      e = index->base.get();
    } else {
      e = std::get<ir::Swizzle>(e->node).base.get();
    }
  }
  std::ranges::reverse(chain);
  return chain;
}

std::size_t commonSteps(const std::vector<std::vector<const ir::Expr*>>& chains) {
  std::size_t common = 0;
  while (true) {
    for (const auto& chain : chains) {
      if (common == chain.size() || !isSameStep(*chain[common], *chains.front()[common])) return common;
    }
    ++common;
  }
}

}  // namespace skc::frontend
