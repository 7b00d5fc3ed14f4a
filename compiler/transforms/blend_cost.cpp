// SPDX-License-Identifier: MIT
#include "transforms/blend_cost.hpp"

#include <algorithm>

#include "ir/walk.hpp"

namespace skc {

using namespace ir;

/// Stops adding at the limit, so that the sum does not overflow.
std::uint32_t BlendCost::of(std::span<const Stmt> statements) {
  std::uint32_t sum = 0;
  for (const Stmt& stmt : statements) sum = std::min(sum + of(stmt), limit);
  return sum;
}

std::uint32_t BlendCost::of(const Stmt& stmt) {
  const bool isLong = std::holds_alternative<Loop>(stmt.node) || std::holds_alternative<Push>(stmt.node) ||
                      std::holds_alternative<Scatter>(stmt.node);
  if (isLong) return limit;
  const auto* call = std::get_if<CallStmt>(&stmt.node);
  std::uint32_t sum = call == nullptr ? 0 : ofCall(call->callee);
  forEachOperand(stmt, [&](const ExprPtr& operand) { sum = std::min(sum + of(*operand), limit); });
  forEachBlock(stmt, [&](const Block& inner) { sum = std::min(sum + of(inner), limit); });
  return sum;
}

std::uint32_t BlendCost::of(const Expr& expr) {
  std::uint32_t sum = 0;
  if (const auto* n = std::get_if<Call>(&expr.node)) sum = ofCall(n->callee);
  const bool isOperation =
      std::holds_alternative<Unary>(expr.node) || std::holds_alternative<Binary>(expr.node) ||
      std::holds_alternative<Select>(expr.node) || std::holds_alternative<Convert>(expr.node);
  if (isOperation) sum = expr.type.width;
  if (std::holds_alternative<IntrinsicCall>(expr.node)) sum = intrinsicCost * expr.type.width;
  if (std::holds_alternative<GatherRead>(expr.node) || std::holds_alternative<Sample>(expr.node))
    sum = gatherCost;
  forEachOperand(expr, [&](const ExprPtr& operand) { sum = std::min(sum + of(*operand), limit); });
  return sum;
}

std::uint32_t BlendCost::ofCall(FunctionId callee) {
  const auto known = calls_.find(callee);
  if (known != calls_.end()) return known->second;
  const std::uint32_t cost = of(module_.functions[callee].body);
  calls_.emplace(callee, cost);
  return cost;
}

}  // namespace skc
