// SPDX-License-Identifier: MIT
#include "analysis/iterations.hpp"

#include <map>

#include "ir/counted_loop.hpp"
#include "ir/walk.hpp"

namespace skc::analysis {
namespace {

using namespace ir;

using Iterations = std::optional<std::int64_t>;

constexpr std::int64_t largestCount = 1 << 20;

Iterations limitedCount(std::int64_t count) {
  return count <= largestCount ? Iterations(count) : std::nullopt;
}
Iterations sumOf(Iterations a, Iterations b) { return a && b ? limitedCount(*a + *b) : std::nullopt; }

class IterationCounter {
 public:
  explicit IterationCounter(const Module& module) : module_(module) {}

  Iterations function(FunctionId id) {
    const auto known = functions_.find(id);
    if (known != functions_.end()) return known->second;
    return functions_[id] = block(module_.functions[id].body);
  }

 private:
  Iterations block(const Block& statements) {
    Iterations total = 0;
    for (const Stmt& stmt : statements) total = sumOf(total, statement(stmt));
    return total;
  }

  Iterations statement(const Stmt& stmt) {
    const auto* assign = std::get_if<Assign>(&stmt.node);
    Iterations once = assign != nullptr && assign->op ? division(*assign->op, assign->place->type) : 0;
    forEachOperand(stmt, [&](const ExprPtr& expr) { once = sumOf(once, expression(*expr)); });
    forEachBlock(stmt, [&](const Block& inner) { once = sumOf(once, block(inner)); });
    if (const auto* call = std::get_if<CallStmt>(&stmt.node)) return sumOf(once, function(call->callee));
    if (std::holds_alternative<Switch>(stmt.node)) return sumOf(once, 1);  // Mesa makes a loop of it
    const auto* loop = std::get_if<Loop>(&stmt.node);
    if (loop == nullptr) return once;
    // The last test of the condition counts as an iteration.
    const Iterations each = sumOf(once, 1), count = sumOf(tripCount(module_, *loop), 1);
    return each && count && *count <= largestCount ? limitedCount(*each * *count) : std::nullopt;
  }

  /// The iterations of an operator. Only divisions of 64-bit integers are loops (`sk_divided` in runtime/src/assemble/glsl/longs.glsl).
  static std::int64_t division(BinaryOp op, const Type& type) {
    constexpr std::int64_t each = 65;
    return (op == BinaryOp::Div || op == BinaryOp::Rem) && type.isLong() ? each * type.width : 0;
  }

  Iterations expression(const Expr& expr) {
    Iterations total = 0;
    walkExprs(expr, [&](const Expr& one) {
      if (const auto* call = std::get_if<Call>(&one.node)) total = sumOf(total, function(call->callee));
      const auto* binary = std::get_if<Binary>(&one.node);
      if (binary != nullptr) total = sumOf(total, division(binary->op, one.type));
    });
    return total;
  }

  const Module& module_;
  std::map<FunctionId, Iterations> functions_;
};

}  // namespace

std::optional<std::int64_t> mostIterations(const Module& module, const Kernel& kernel) {
  return IterationCounter(module).function(kernel.entry);
}

}  // namespace skc::analysis
