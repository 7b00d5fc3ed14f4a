// SPDX-License-Identifier: MIT
#include "ir/counted_loop.hpp"

#include "ir/build.hpp"
#include "ir/evaluate.hpp"
#include "ir/walk.hpp"

namespace skc::ir {
namespace {

bool assigns(const Block& block, VarId var) {
  bool found = false;
  walkStmts(block, [&](const Stmt& stmt) {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) found = found || rootOf(*n->place) == var;
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) {
      for (const ExprPtr& arg : n->args)
        walkExprs(*arg, [&](const Expr& expr) {
          const auto* ref = std::get_if<VarRef>(&expr.node);
          found = found || (ref != nullptr && ref->var == var);
        });
      if (n->result) found = found || rootOf(*n->result) == var;
    }
  });
  return found;
}

/// The parts of a counted loop's head: `from; var op to; var stepOp by`.
struct Head {
  Type type;
  std::uint32_t from, to, by;
  BinaryOp op, stepOp;
};

std::optional<Head> headOf(const Module& module, const Loop& loop) {
  if (loop.init.size() != 1 || loop.step.size() != 1 || !loop.cond) return std::nullopt;
  const auto* init = std::get_if<Declare>(&loop.init.front().node);
  const auto* test = std::get_if<Binary>(&loop.cond->node);
  const auto* step = std::get_if<Assign>(&loop.step.front().node);
  if (init == nullptr || !init->init || test == nullptr || step == nullptr || !step->op) return std::nullopt;
  const auto* tested = std::get_if<VarRef>(&test->lhs->node);
  const auto* stepped = std::get_if<VarRef>(&step->place->node);
  if (!isComparison(test->op) || tested == nullptr || stepped == nullptr || tested->var != init->var ||
      stepped->var != init->var || assigns(loop.body, init->var))
    return std::nullopt;
  const auto from = evaluate(module, *init->init, Constants::LookThrough);
  const auto to = evaluate(module, *test->rhs, Constants::LookThrough);
  const auto by = evaluate(module, *step->value, Constants::LookThrough);
  if (!from || !to || !by) return std::nullopt;
  return Head{init->init->type, *from, *to, *by, test->op, *step->op};
}

/// ceil(distance / step), 0 where there is nothing to go.
std::int64_t stepsOver(std::int64_t distance, std::int64_t step) {
  return distance <= 0 ? 0 : (distance + step - 1) / step;
}

}  // namespace

bool isCounted(const Module& module, const Loop& loop) { return headOf(module, loop).has_value(); }

std::optional<std::int64_t> roundsOf(const Module& module, const Loop& loop) {
  const std::optional<Head> head = headOf(module, loop);
  if (!head || !head->type.isScalar() || !head->type.isInteger()) return std::nullopt;
  if (head->stepOp != BinaryOp::Add && head->stepOp != BinaryOp::Sub) return std::nullopt;
  const auto integer = [&](std::uint32_t bits) {
    return head->type.scalar == Scalar::Int ? std::int64_t{static_cast<std::int32_t>(bits)}
                                            : std::int64_t{bits};
  };
  const std::int64_t signedBy = static_cast<std::int32_t>(head->by);
  const std::int64_t by = head->stepOp == BinaryOp::Add ? signedBy : -signedBy;
  const std::int64_t distance = integer(head->to) - integer(head->from);
  switch (head->op) {
    case BinaryOp::Less: return by > 0 ? std::optional(stepsOver(distance, by)) : std::nullopt;
    case BinaryOp::LessEqual: return by > 0 ? std::optional(stepsOver(distance + 1, by)) : std::nullopt;
    case BinaryOp::Greater: return by < 0 ? std::optional(stepsOver(-distance, -by)) : std::nullopt;
    case BinaryOp::GreaterEqual: return by < 0 ? std::optional(stepsOver(-distance + 1, -by)) : std::nullopt;
    case BinaryOp::NotEqual:
      return by != 0 && distance % by == 0 && distance / by >= 0 ? std::optional(distance / by)
                                                                 : std::nullopt;
    default: return std::nullopt;
  }
}

}  // namespace skc::ir
