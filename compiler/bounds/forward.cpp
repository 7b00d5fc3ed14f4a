// SPDX-License-Identifier: MIT
//
// Evaluator's way from the inputs to the result: exact values, errors, and derivatives of each operation.
#include "bounds/evaluator.hpp"

#include <algorithm>
#include <cmath>

namespace skc::bounds {
namespace {

constexpr Interval unknown = Interval::whole();

}  // namespace

Interval stepped(Op op, Interval x) {
  switch (op) {
    case Op::Floor: return {std::floor(x.low), std::floor(x.high)};
    case Op::Ceil: return {std::ceil(x.low), std::ceil(x.high)};
    case Op::Truncate: return {std::trunc(x.low), std::trunc(x.high)};
    default: return {std::nearbyint(x.low), std::nearbyint(x.high)};
  }
}

// ---- forward --------------------------------------------------------------------------------------

void Evaluator::forward(std::span<const Interval> box, std::span<const Decision> decisions) {
  for (const NodeId id : order_) visit(id, box, decisions);
}

/// Keeps what the decisions say about the operands of comparisons. Returns false if they contradict the values.
bool Evaluator::limitByDecisions(std::span<const Decision> decisions) {
  hasLimits_ = false;
  for (const NodeId id : comparisons_) {
    const Decision decision = decisions[comparisonNumber_[id]];
    if (decision == Decision::Open) continue;
    const Node& node = graph_[id];
    const Interval x = slots_[node.operands[0]].exact, y = slots_[node.operands[1]].exact;
    Interval &left = limits_[node.operands[0]], &right = limits_[node.operands[1]];
    if (node.op == Op::Equal) {
      if (decision == Decision::No) continue;
      left = intersection(left, y);
      right = intersection(right, x);
      if (intersection(x, y).isEmpty()) return false;
    } else if (decision == Decision::Yes) {
      if (x.low > y.high || (node.op == Op::Less && x.low == y.high)) return false;
      left.high = std::min(left.high, y.high);
      right.low = std::max(right.low, x.low);
    } else {
      if (x.high < y.low || (node.op == Op::LessEqual && x.high == y.low)) return false;
      left.low = std::max(left.low, y.low);
      right.high = std::min(right.high, x.high);
    }
    hasLimits_ = true;
  }
  return true;
}

void Evaluator::visit(NodeId id, std::span<const Interval> box, std::span<const Decision> decisions) {
  const Node& node = graph_[id];
  if (isCondition(node.op)) return visitCondition(id, decisions);
  Slot& slot = slots_[id];
  slot.problem = Problem::None;
  const auto operand = [&](std::size_t k) -> const Slot& { return slots_[node.operands[k]]; };
  const auto one = Interval::point(1);
  switch (node.op) {
    case Op::Input: slot.exact = box[node.index]; break;
    case Op::Constant:
      // A text whose value no double has: the exact number is within the error.
      slot.exact = node.rounding.kind == Rounding::Kind::Absolute
                       ? widened(Interval::point(node.value), node.rounding.amount)
                       : Interval::point(node.value);
      break;
    case Op::Round:
      slot.exact = operand(0).exact;
      slot.slopes[0] = one;
      break;
    case Op::Negate:
      slot.exact = -operand(0).exact;
      slot.slopes[0] = Interval::point(-1);
      break;
    case Op::Absolute: {
      slot.exact = absolute(operand(0).exact);
      const Interval x = operand(0).between;
      slot.slopes[0] = {x.low >= 0 ? 1.0 : -1.0, x.high <= 0 ? -1.0 : 1.0};
      break;
    }
    case Op::Add:
      slot.exact = operand(0).exact + operand(1).exact;
      slot.slopes[0] = slot.slopes[1] = one;
      break;
    case Op::Subtract:
      slot.exact = operand(0).exact - operand(1).exact;
      slot.slopes[0] = one;
      slot.slopes[1] = Interval::point(-1);
      break;
    case Op::Multiply:
      slot.exact = node.operands[0] == node.operands[1] ? square(operand(0).exact)
                                                        : operand(0).exact * operand(1).exact;
      slot.slopes[0] = operand(1).between;
      slot.slopes[1] = operand(0).between;
      break;
    case Op::MultiplyAdd:
      slot.exact = operand(0).exact * operand(1).exact + operand(2).exact;
      slot.slopes[0] = operand(1).between;
      slot.slopes[1] = operand(0).between;
      slot.slopes[2] = one;
      break;
    case Op::Divide: {
      const Interval x = operand(0).between, y = operand(1).between;
      slot.exact = operand(0).exact / operand(1).exact;
      if (operand(1).exact.contains(0) || y.contains(0)) slot.problem = Problem::DivisionByZero;
      slot.slopes[0] = one / y;
      slot.slopes[1] = -((x / y) / y);
      break;
    }
    case Op::Min:
    case Op::Max: {
      const bool isMin = node.op == Op::Min;
      slot.exact =
          isMin ? smaller(operand(0).exact, operand(1).exact) : larger(operand(0).exact, operand(1).exact);
      const Interval x = operand(0).between, y = operand(1).between;
      const bool neverFirst = isMin ? x.low > y.high : x.high < y.low;
      const bool neverSecond = isMin ? y.low > x.high : y.high < x.low;
      slot.slopes[0] = {neverSecond ? 1.0 : 0.0, neverFirst ? 0.0 : 1.0};
      slot.slopes[1] = {neverFirst ? 1.0 : 0.0, neverSecond ? 0.0 : 1.0};
      break;
    }
    case Op::Call:
    case Op::Call2: visitCall(node, slot); break;
    case Op::Floor:
    case Op::Ceil:
    case Op::Truncate:
    case Op::RoundEven:
      slot.exact = stepped(node.op, operand(0).exact);
      slot.slopes[0] = Interval::point(0);
      break;
    case Op::Select: visitSelect(node, slot); break;
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::And:
    case Op::Or:
    case Op::Not: break;
  }
  finish(id, node, slot);
}

void Evaluator::visitSelect(const Node& node, Slot& slot) {
  const Decision truth = slots_[node.operands[0]].truth;
  const Slot &yes = slots_[node.operands[1]], &no = slots_[node.operands[2]];
  slot.slopes[0] = Interval::point(0);
  slot.slopes[1] = {truth == Decision::Yes ? 1.0 : 0.0, truth == Decision::No ? 0.0 : 1.0};
  slot.slopes[2] = {truth == Decision::No ? 1.0 : 0.0, truth == Decision::Yes ? 0.0 : 1.0};
  slot.exact = truth == Decision::Yes  ? yes.exact
               : truth == Decision::No ? no.exact
                                       : hull(yes.exact, no.exact);
}

void Evaluator::visitCall(const Node& node, Slot& slot) {
  const Slot& x = slots_[node.operands[0]];
  if (node.op == Op::Call2) {
    const Slot& y = slots_[node.operands[1]];
    slot.exact = valueOf(node.function2, x.exact, y.exact);
    if (!isDefined(node.function2, x.exact, y.exact) || !isDefined(node.function2, x.computed, y.computed)) {
      slot.problem = Problem::Undefined;
    }
    const Slopes slopes = slopesOf(node.function2, x.between, y.between);
    slot.slopes[0] = slopes.x;
    slot.slopes[1] = slopes.y;
    return;
  }
  slot.exact = valueOf(node.function, x.exact);
  if (!isDefined(node.function, x.exact) || !isDefined(node.function, x.computed)) {
    slot.problem = Problem::Undefined;
  }
  slot.slopes[0] = isDefined(node.function, x.between) ? slopeOf(node.function, x.between) : unknown;
}

/// Propagates errors to the node, and adds its own.
void Evaluator::finish(NodeId id, const Node& node, Slot& slot) {
  if (hasLimits_) slot.exact = intersection(slot.exact, limits_[id]);
  double propagated = 0;
  if (node.op == Op::Select) {
    // One of the two sides.
    for (std::size_t k = 1; k < 3; ++k)
      propagated = std::max(propagated, productUp(slot.slopes[k].high, slots_[node.operands[k]].error));
  } else {
    for (std::size_t k = 0; k < 3 && node.operands[k] != noNode; ++k) {
      const double error = slots_[node.operands[k]].error;
      if (error != 0) propagated = sumUp(propagated, productUp(slot.slopes[k].magnitude(), error));
    }
  }
  // Where the derivative grows without limit, or a clamp holds values, the values themselves say more: the operands' errors count here,
  // and not again where they arise.
  double kept = 0;
  if (const double direct = directErrorOf(node, slot, propagated); direct < propagated) {
    propagated = kept = direct;
    slot.slopes.fill(Interval::point(0));
  }
  const Interval unrounded = widened(slot.exact, propagated);
  const double rounding = roundingOf(node, unrounded);
  slot.own = sumUp(kept, rounding);
  slot.error = sumUp(propagated, rounding);
  slot.between = widened(slot.exact, slot.error);
  if (node.op == Op::Min || node.op == Op::Max) slot.between = intersection(slot.between, extremeOf(node));
  slot.computed = tracks_[id] ? computedOf(node, slot) : slot.between;
  if (slot.problem != Problem::None) return;
  if (node.integer != Integer::No) {
    const Interval range =
        node.integer == Integer::Signed ? Interval{-0x1p31, 0x1p31 - 1} : Interval{0, 0x1p32 - 1};
    if (slot.exact.low < range.low || slot.exact.high > range.high) slot.problem = Problem::IntegerOverflow;
  } else if (node.rounding.kind != Rounding::Kind::Exact &&
             !(slot.between.magnitude() <= node.rounding.format.largest)) {
    slot.problem = Problem::Overflow;
  }
}

// ---- conditions -----------------------------------------------------------------------------------

Decision Evaluator::truthOf(NodeId condition) const {
  const Node& node = graph_[condition];
  if (node.op == Op::Constant) return node.value != 0 ? Decision::Yes : Decision::No;
  return slots_[condition].truth;
}

void Evaluator::visitCondition(NodeId id, std::span<const Decision> decisions) {
  const Node& node = graph_[id];
  Slot& slot = slots_[id];
  slot.isLive = false;
  if (isComparison(node.op)) {
    const bool isTurnedHere = std::ranges::binary_search(turned_, id);
    const Decision decision = decisions[comparisonNumber_[id]];
    if (decision != Decision::Open && !isTurnedHere) {
      slot.truth = decision;
      return;
    }
    const Slot &left = slots_[node.operands[0]], &right = slots_[node.operands[1]];
    const Interval x = isTurnedHere ? left.between : left.exact,
                   y = isTurnedHere ? right.between : right.exact;
    slot.truth = Decision::Open;
    if (node.op == Op::Less) {
      if (x.high < y.low) slot.truth = Decision::Yes;
      if (x.low >= y.high) slot.truth = Decision::No;
    } else if (node.op == Op::LessEqual) {
      if (x.high <= y.low) slot.truth = Decision::Yes;
      if (x.low > y.high) slot.truth = Decision::No;
    } else {
      if (x.high < y.low || y.high < x.low) slot.truth = Decision::No;
      if (x.isPoint() && y.isPoint() && x.low == y.low) slot.truth = Decision::Yes;
    }
    return;
  }
  const Decision a = truthOf(node.operands[0]);
  if (node.op == Op::Not) {
    slot.truth = a == Decision::Open ? a : a == Decision::Yes ? Decision::No : Decision::Yes;
    return;
  }
  const Decision b = truthOf(node.operands[1]);
  const Decision strong = node.op == Op::And ? Decision::No : Decision::Yes;  // decides whatever the other is
  const Decision weak = node.op == Op::And ? Decision::Yes : Decision::No;
  slot.truth = a == strong || b == strong ? strong : a == weak && b == weak ? weak : Decision::Open;
}

}  // namespace skc::bounds
