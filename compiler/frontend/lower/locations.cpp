// SPDX-License-Identifier: MIT
#include "frontend/lower/locations.hpp"

#include <algorithm>
#include <cassert>

namespace skc::frontend {
namespace {

/// What a member, element or component is a part of; null for anything else.
ir::ExprPtr* baseOf(ir::Expr& e) {
  if (auto* member = std::get_if<ir::Member>(&e.node)) return &member->base;
  if (auto* index = std::get_if<ir::Index>(&e.node)) return &index->base;
  if (auto* swizzle = std::get_if<ir::Swizzle>(&e.node)) return &swizzle->base;
  return nullptr;
}

const ir::Expr* baseOf(const ir::Expr& e) {
  const ir::ExprPtr* base = baseOf(const_cast<ir::Expr&>(e));
  return base == nullptr ? nullptr : base->get();
}

/// True for the values of constants, and for elements of gathers.
bool isUnchanging(const ir::Expr& e) {
  return std::holds_alternative<ir::ConstantRef>(e.node) || std::holds_alternative<ir::Literal>(e.node) ||
         std::holds_alternative<ir::Construct>(e.node) || std::holds_alternative<ir::GatherRead>(e.node);
}

void addRoots(const ir::Expr& location, std::vector<ir::VarId>& roots) {
  if (const auto* variable = std::get_if<ir::VarRef>(&location.node)) {
    roots.push_back(variable->var);
  } else if (const auto* choice = std::get_if<ir::Select>(&location.node)) {
    addRoots(*choice->yes, roots);
    addRoots(*choice->no, roots);
  } else if (const ir::Expr* base = baseOf(location)) {
    addRoots(*base, roots);
  }
}

}  // namespace

bool isLocation(const ir::Expr& e) {
  if (const auto* choice = std::get_if<ir::Select>(&e.node))
    return choice->cond->type.isScalar() && isLocation(*choice->yes) && isLocation(*choice->no);
  if (const ir::Expr* base = baseOf(e)) return isLocation(*base);
  return std::holds_alternative<ir::VarRef>(e.node) || isUnchanging(e);
}

bool isWritable(const ir::Expr& e) {
  if (std::holds_alternative<ir::VarRef>(e.node)) return true;
  if (const auto* choice = std::get_if<ir::Select>(&e.node))
    return choice->cond->type.isScalar() && isWritable(*choice->yes) && isWritable(*choice->no);
  const ir::Expr* base = baseOf(e);
  return base != nullptr && isWritable(*base);
}

std::vector<ir::VarId> rootsOf(const ir::Expr& location) {
  std::vector<ir::VarId> roots;
  addRoots(location, roots);
  std::ranges::sort(roots);
  const auto repeated = std::ranges::unique(roots);
  roots.erase(repeated.begin(), repeated.end());
  return roots;
}

ir::Select* choiceIn(ir::Expr& location) {
  if (auto* choice = std::get_if<ir::Select>(&location.node)) return choice;
  ir::ExprPtr* base = baseOf(location);
  return base == nullptr ? nullptr : choiceIn(**base);
}

void choose(ir::ExprPtr& location, bool yes) {
  if (auto* choice = std::get_if<ir::Select>(&location->node)) {
    ir::ExprPtr chosen = std::move(yes ? choice->yes : choice->no);
    location = std::move(chosen);
    return;
  }
  ir::ExprPtr* base = baseOf(*location);
  assert(base != nullptr && "an lvalue has no choice");
  choose(*base, yes);
}

}  // namespace skc::frontend
