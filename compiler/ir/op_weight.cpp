// SPDX-License-Identifier: MIT
#include "ir/op_weight.hpp"

#include <algorithm>
#include <set>

#include "ir/walk.hpp"

namespace skc::ir {

bool isOperation(const Expr& expr) {
  return std::holds_alternative<Unary>(expr.node) || std::holds_alternative<Binary>(expr.node) ||
         std::holds_alternative<Select>(expr.node) || std::holds_alternative<Convert>(expr.node);
}

namespace {

/// The weight of an expression without its operands and callees.
std::uint32_t ownWeight(const Expr& expr, const OpWeights& weights) {
  if (isOperation(expr)) return weights.node + weights.operation * expr.type.width;
  if (std::holds_alternative<IntrinsicCall>(expr.node))
    return weights.node + weights.intrinsic * expr.type.width;
  if (std::holds_alternative<GatherRead>(expr.node)) return weights.node + weights.gather;
  if (std::holds_alternative<Sample>(expr.node)) return weights.node + weights.sample;
  return weights.node;
}

/// Adds weights up to the limit.
class Scale {
 public:
  Scale(const Module& module, const OpWeights& weights, std::uint32_t limit)
      : module_(module), weights_(weights), limit_(limit) {}

  std::uint32_t sum() const { return std::min(sum_, limit_); }

  void add(std::span<const Stmt> statements) {
    for (const Stmt& stmt : statements) {
      if (sum_ >= limit_) return;
      add(stmt);
    }
  }

 private:
  void add(const Stmt& stmt) {
    if (std::holds_alternative<Loop>(stmt.node)) sum_ = limit_;
    if (std::holds_alternative<Push>(stmt.node) || std::holds_alternative<Scatter>(stmt.node) ||
        std::holds_alternative<Print>(stmt.node))
      sum_ += weights_.append;
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) addCalled(n->callee);
    forEachOperand(stmt, [&](const ExprPtr& operand) {
      walkExprs(*operand, [&](const Expr& expr) {
        sum_ += ownWeight(expr, weights_);
        if (const auto* n = std::get_if<Call>(&expr.node)) addCalled(n->callee);
      });
    });
    forEachBlock(stmt, [&](const Block& inner) { add(inner); });
  }

  void addCalled(FunctionId callee) {
    if (called_.insert(callee).second || weights_.countsCalls) add(module_.functions[callee].body);
  }

  const Module& module_;
  const OpWeights& weights_;
  const std::uint32_t limit_;
  std::uint32_t sum_ = 0;
  std::set<FunctionId> called_;
};

}  // namespace

std::uint32_t weigh(const Module& module, std::span<const Stmt> statements, const OpWeights& weights,
                    std::uint32_t limit) {
  Scale scale(module, weights, limit);
  scale.add(statements);
  return scale.sum();
}

}  // namespace skc::ir
