// SPDX-License-Identifier: MIT
#include "ir/counted_loop.hpp"

#include <utility>

#include "ir/build.hpp"
#include "ir/evaluate.hpp"
#include "ir/lvalue.hpp"
#include "ir/operators.hpp"

namespace skc::ir {
namespace {

/// The parts of a counted loop's head: `from; var op to; var stepOp by`.
struct Head {
  VarId counter;
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
      stepped->var != init->var || assigns(module, loop.body, init->var))
    return std::nullopt;
  const auto from = evaluate(module, *init->init, Constants::LookThrough);
  const auto to = evaluate(module, *test->rhs, Constants::LookThrough);
  const auto by = evaluate(module, *step->value, Constants::LookThrough);
  if (!from || !to || !by) return std::nullopt;
  return Head{init->var, init->init->type, *from, *to, *by, test->op, *step->op};
}

/// ceil(distance / step), or 0 if the distance is not positive.
std::int64_t stepsOver(std::int64_t distance, std::int64_t step) {
  return distance <= 0 ? 0 : (distance + step - 1) / step;
}

/// The number of steps of `by`, from 0, until `counter op distance` is false; nullopt if it stays true.
std::optional<std::int64_t> stepsTo(BinaryOp op, std::int64_t distance, std::int64_t by) {
  switch (op) {
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

}  // namespace

bool isCounted(const Module& module, const Loop& loop) { return headOf(module, loop).has_value(); }

ExprPtr CountedLoop::value(std::int64_t iteration, Loc loc) const {
  return makeExpr(type, Literal{static_cast<std::uint32_t>(first + iteration * step)}, loc);
}

std::optional<CountedLoop> countedLoop(const Module& module, const Loop& loop) {
  const std::optional<Head> head = headOf(module, loop);
  if (!head || !head->type.isScalar() || !head->type.isInteger()) return std::nullopt;
  if (head->stepOp != BinaryOp::Add && head->stepOp != BinaryOp::Sub) return std::nullopt;
  const bool isSigned = head->type.scalar == Scalar::Int;
  const auto integer = [&](std::uint32_t bits) {
    return isSigned ? std::int64_t{static_cast<std::int32_t>(bits)} : std::int64_t{bits};
  };
  const std::int64_t signedBy = static_cast<std::int32_t>(head->by);
  const std::int64_t by = head->stepOp == BinaryOp::Add ? signedBy : -signedBy;
  const std::int64_t from = integer(head->from);
  const std::optional<std::int64_t> count = stepsTo(head->op, integer(head->to) - from, by);
  if (!count) return std::nullopt;
  // `for (uint i = 3; i >= 0; --i)` wraps around and does not end.
  const std::int64_t end = from + *count * by;
  const auto [low, high] = isSigned ? std::pair{-(std::int64_t{1} << 31), (std::int64_t{1} << 31) - 1}
                                    : std::pair{std::int64_t{0}, (std::int64_t{1} << 32) - 1};
  if (end < low || end > high) return std::nullopt;
  return CountedLoop{head->counter, head->type, from, by, *count};
}

std::optional<std::int64_t> tripCount(const Module& module, const Loop& loop) {
  const std::optional<CountedLoop> counted = countedLoop(module, loop);
  return counted ? std::optional(counted->count) : std::nullopt;
}

}  // namespace skc::ir
