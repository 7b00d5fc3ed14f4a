// SPDX-License-Identifier: MIT
#include "bounds/evaluator.hpp"

#include <algorithm>
#include <cmath>

namespace skc::bounds {
namespace {

constexpr Interval unknown = Interval::whole();

Interval stepped(Op op, Interval x) {
  switch (op) {
    case Op::Floor: return {std::floor(x.low), std::floor(x.high)};
    case Op::Ceil: return {std::ceil(x.low), std::ceil(x.high)};
    case Op::Truncate: return {std::trunc(x.low), std::trunc(x.high)};
    default: return {std::nearbyint(x.low), std::nearbyint(x.high)};
  }
}

/// The number of the format that is nearest to x; infinity keeps what is beyond the format.
double nearest(const Format& format, double x) {
  if (format.unit == floatFormat.unit) return static_cast<double>(static_cast<float>(x));
  return x;
}

/// The ends of what a device computes in doubles: its operations are rounded to nearest, which keeps order.
Interval inDoubles(const Node& node, Interval x, Interval y) {
  const auto ends = [](double a, double b, double c, double d) {
    return Interval{std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d))};
  };
  switch (node.op) {
    case Op::Add: return {x.low + y.low, x.high + y.high};
    case Op::Subtract: return {x.low - y.high, x.high - y.low};
    case Op::Multiply:
      if (node.operands[0] == node.operands[1]) {
        return {x.smallest() * x.smallest(), x.magnitude() * x.magnitude()};
      }
      return ends(x.low * y.low, x.low * y.high, x.high * y.low, x.high * y.high);
    case Op::Divide:
      if (y.contains(0)) return unknown;
      return ends(x.low / y.low, x.low / y.high, x.high / y.low, x.high / y.high);
    default: return unknown;
  }
}

/// True where the difference of two numbers of a format is one, too (Sterbenz 1974).
bool isDifferenceExact(Interval x, Interval y) {
  if (x.high < 0 && y.high < 0) return isDifferenceExact(-x, -y);
  return x.low > 0 && y.low > 0 && y.high <= 2 * x.low && x.high <= 2 * y.low;
}

bool mayFail(const Node& node) {
  if (node.op == Op::Call2) return true;
  return node.op == Op::Call && !isDefined(node.function, Interval::whole());
}

}  // namespace

Evaluator::Evaluator(const Graph& graph, NodeId output)
    : graph_(graph),
      output_(output),
      order_(graph.neededBy({output})),
      comparisonNumber_(graph.size(), 0),
      tracks_(graph.size(), false),
      slots_(graph.size()),
      limits_(graph.size(), unknown) {
  for (const NodeId id : order_) {
    const Node& node = graph_[id];
    if (isComparison(node.op)) {
      comparisonNumber_[id] = static_cast<std::uint32_t>(comparisons_.size());
      comparisons_.push_back(id);
    }
    if (isComparison(node.op) || isStep(node.op)) turns_.push_back(id);
    if (node.op == Op::Input) inputs_.push_back(node.index);
  }
  for (auto it = order_.rbegin(); it != order_.rend(); ++it) {
    const Node& node = graph_[*it];
    if (!tracks_[*it] && !mayFail(node)) continue;
    for (const NodeId operand : node.operands) {
      if (operand != noNode) tracks_[operand] = true;
    }
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
  double terms = 0;
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
  if (node.op == Op::Call) {
    // Where the derivative grows without limit, the values themselves say more: the operand's error counts here, and not again where
    // it arises. |sqrt(a) - sqrt(b)| is at most sqrt(|a - b|).
    const Slot& x = slots_[node.operands[0]];
    double direct = infinity;
    if (x.error != 0 && node.function == UnaryFunction::Sqrt) direct = roundedUp(std::sqrt(x.error));
    if (x.error != 0 && !(propagated < infinity)) {
      const Interval values = valueOf(node.function, hull(x.exact, x.computed));
      direct = std::min(direct, roundedUp(values.width()));
    }
    if (direct < propagated) {
      propagated = direct;
      terms = direct;
      slot.slopes[0] = Interval::point(0);
    }
  }
  const Interval unrounded = widened(slot.exact, propagated);
  const double rounding = roundingOf(node, unrounded);
  slot.own = sumUp(terms, rounding);
  slot.error = sumUp(propagated, rounding);
  slot.between = widened(slot.exact, slot.error);
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

/// The largest difference between the device's operation and the exact one, where the exact one gives numbers of `unrounded`.
double Evaluator::roundingOf(const Node& node, Interval unrounded) const {
  const Rounding& rounding = node.rounding;
  if (rounding.kind == Rounding::Kind::Exact) return 0;
  if (rounding.kind == Rounding::Kind::Absolute) return rounding.amount;
  const Format& format = rounding.format;
  const double magnitude = unrounded.magnitude();
  if (magnitude == 0) return 0;
  if (!(magnitude < infinity)) return infinity;
  if (node.op == Op::Round && graph_[node.operands[0]].integer != Integer::No && magnitude <= 1 / format.unit)
    return 0;  // all integers up to here are numbers of the format
  const double lost =
      format.flushes && unrounded.smallest() < format.smallest ? std::min(magnitude, format.smallest) : 0;
  if (rounding.isScaling && rounding.kind == Rounding::Kind::Nearest) {
    if (unrounded.smallest() >= format.smallest) return 0;
    return std::max(lost, format.unit * format.smallest);
  }
  if (format.isRelative)
    return std::max(lost, roundedUp(magnitude * format.unit * std::max(1.0, 2 * rounding.amount)));
  double error;
  if (rounding.kind == Rounding::Kind::Units) {
    const double above = roundedUp(magnitude * (1 + 2 * format.unit));
    error = 2 * rounding.amount * format.unit * powerBelow(std::max(above, format.smallest));
  } else {
    // Up to a power of 2, numbers are twice as close as above it, and no farther from it than they are above it.
    const double power = powerBelow(std::max(magnitude, format.smallest));
    const double above = magnitude > power ? roundedUp(magnitude - power) : 0;
    error = power == format.smallest ? format.unit * power
                                     : std::max(format.unit * power / 2, std::min(above, format.unit * power));
    if (node.op == Op::Add || node.op == Op::Subtract) {
      const Interval x = slots_[node.operands[0]].between, y = slots_[node.operands[1]].between;
      // Either operand is a candidate for the nearest number.
      error = std::min(error, std::min(x.magnitude(), y.magnitude()));
      if (isDifferenceExact(x, node.op == Op::Add ? -y : y)) error = 0;
    }
  }
  return std::max(lost, error);
}

/// The range of computed values, which rounding to nearest keeps from leaving a range of numbers of the format: a square is never negative.
Interval Evaluator::computedOf(const Node& node, const Slot& slot) const {
  const auto operand = [&](std::size_t k) { return slots_[node.operands[k]].computed; };
  Interval range = slot.between;
  switch (node.op) {
    case Op::Input:
      // A format has the ends of most ranges, and rounding does not cross them.
      if (nearest(node.rounding.format, slot.exact.low) == slot.exact.low) range.low = slot.exact.low;
      if (nearest(node.rounding.format, slot.exact.high) == slot.exact.high) range.high = slot.exact.high;
      return range;
    case Op::Negate: return intersection(range, -operand(0));
    case Op::Absolute: return intersection(range, absolute(operand(0)));
    case Op::Min: return intersection(range, smaller(operand(0), operand(1)));
    case Op::Max: return intersection(range, larger(operand(0), operand(1)));
    case Op::Add:
    case Op::Subtract:
    case Op::Multiply:
    case Op::Divide: {
      const Rounding& rounding = node.rounding;
      if (rounding.kind != Rounding::Kind::Nearest || rounding.format.isRelative) return range;
      const bool isDouble = rounding.format.unit == doubleFormat.unit;
      Interval result;
      if (isDouble) {
        result = inDoubles(node, operand(0), operand(1));
      } else {
        const Interval x = operand(0), y = operand(1);
        result = node.op == Op::Add                     ? x + y
                 : node.op == Op::Subtract              ? x - y
                 : node.op == Op::Divide                ? x / y
                 : node.operands[0] == node.operands[1] ? square(x)
                                                        : x * y;
        result = {nearest(rounding.format, result.low), nearest(rounding.format, result.high)};
      }
      if (!(result.low <= result.high)) return range;
      const Interval common = intersection(range, result);
      return common.isEmpty() ? range : common;
    }
    case Op::Call: {
      // An error below a unit changes no sign, and takes no value past 1, around which units are larger above than below.
      const Interval values = valueOf(node.function, operand(0));
      if (node.rounding.kind == Rounding::Kind::Units && node.rounding.amount >= 2) return range;
      if (values.low >= 0) range.low = std::max(range.low, 0.0);
      if (values.low >= -1) range.low = std::max(range.low, -1.0);
      if (values.high <= 1) range.high = std::min(range.high, 1.0);
      return range;
    }
    case Op::Select: {
      const Decision truth = slots_[node.operands[0]].truth;
      if (truth == Decision::Yes) return intersection(range, operand(1));
      if (truth == Decision::No) return intersection(range, operand(2));
      return intersection(range, hull(operand(1), operand(2)));
    }
    case Op::Constant:
    case Op::Round:
    case Op::MultiplyAdd:
    case Op::Call2:
    case Op::Floor:
    case Op::Ceil:
    case Op::Truncate:
    case Op::RoundEven:
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::And:
    case Op::Or:
    case Op::Not: return range;
  }
  return range;
}

// ---- conditions -----------------------------------------------------------------------------------

void Evaluator::visitCondition(NodeId id, std::span<const Decision> decisions) {
  const Node& node = graph_[id];
  Slot& slot = slots_[id];
  slot.isLive = false;
  const auto truthOf = [&](NodeId operand) {
    const Node& one = graph_[operand];
    if (one.op == Op::Constant) return one.value != 0 ? Decision::Yes : Decision::No;
    return slots_[operand].truth;
  };
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

// ---- backward -------------------------------------------------------------------------------------

void Evaluator::backward() {
  for (const NodeId id : order_) {
    slots_[id].adjoint = Interval::point(0);
    slots_[id].isLive = false;
  }
  slots_[output_].adjoint = Interval::point(1);
  slots_[output_].isLive = true;
  for (auto it = order_.rbegin(); it != order_.rend(); ++it) {
    const Slot& slot = slots_[*it];
    if (!slot.isLive) continue;
    const Node& node = graph_[*it];
    if (isCondition(node.op)) {
      for (const NodeId operand : node.operands) {
        if (operand != noNode) slots_[operand].isLive = true;
      }
      continue;
    }
    for (std::size_t k = 0; k < 3 && node.operands[k] != noNode; ++k) {
      Slot& operand = slots_[node.operands[k]];
      const Interval slope = slot.slopes[k];
      if (node.op == Op::Select) {
        // A side that is not chosen does not count, nor does a condition that is decided.
        const bool isOpen = slots_[node.operands[0]].truth == Decision::Open;
        if (k == 0 ? !isOpen : slope.high == 0) continue;
      }
      operand.isLive = true;
      if (slope.low == 1 && slope.high == 1) {
        operand.adjoint = operand.adjoint + slot.adjoint;
      } else if (slope.low != 0 || slope.high != 0) {
        operand.adjoint = operand.adjoint + slot.adjoint * slope;
      }
    }
  }
}

BoxResult Evaluator::evaluate(std::span<const Interval> box, std::span<const Decision> decisions) {
  BoxResult result;
  if (hasLimits_) {
    std::ranges::fill(limits_, unknown);
    hasLimits_ = false;
  }
  forward(box, decisions);
  const bool isDecided = std::ranges::any_of(decisions, [](Decision d) { return d != Decision::Open; });
  if (isDecided) {
    // Two rounds: the first finds the limits, the second uses them.
    if (!limitByDecisions(decisions)) return result.isImpossible = true, result;
    if (hasLimits_) {
      forward(box, decisions);
      for (const NodeId id : order_) {
        if (!isCondition(graph_[id].op) && slots_[id].exact.isEmpty())
          return result.isImpossible = true, result;
      }
      if (!limitByDecisions(decisions)) return result.isImpossible = true, result;
    }
  }
  backward();
  const Slot& output = slots_[output_];
  result.value = output.exact;
  double sum = 0, count = 0;
  for (const NodeId id : order_) {
    const Slot& slot = slots_[id];
    if (!slot.isLive) continue;
    const Node& node = graph_[id];
    if (isComparison(node.op)) {
      if (slot.truth == Decision::Open && result.undecided == noNode) result.undecided = id;
      continue;
    }
    if (isCondition(node.op)) continue;
    if (slot.problem != Problem::None && result.problem == Problem::None) {
      result.problem = slot.problem;
      result.culprit = id;
    }
    if (slot.own == 0) continue;
    sum += productUp(slot.own, slot.adjoint.magnitude());
    ++count;
  }
  sum = roundedUp(sum, 0x1p-52 * (count + 1));
  result.error = result.problem != Problem::None ? infinity : std::min(sum, output.error);
  return result;
}

std::vector<Evaluator::Share> Evaluator::shares() const {
  std::vector<Share> shares;
  for (const NodeId id : order_) {
    const Slot& slot = slots_[id];
    if (!slot.isLive || isCondition(graph_[id].op) || slot.own == 0) continue;
    const double error = productUp(slot.own, slot.adjoint.magnitude());
    if (error > 0) shares.push_back({id, error});
  }
  return shares;
}

// ---- jumps ----------------------------------------------------------------------------------------

/// True if the computed operands may decide otherwise than the exact ones.
bool Evaluator::isTurned(NodeId id) const {
  const Node& node = graph_[id];
  const Slot& x = slots_[node.operands[0]];
  if (isStep(node.op)) {
    if (x.error == 0) return false;
    const Interval steps = stepped(node.op, x.between);
    return steps.low != steps.high;
  }
  const Slot& y = slots_[node.operands[1]];
  return slots_[id].truth == Decision::Open && (x.error > 0 || y.error > 0);
}

double Evaluator::jumpOf(std::span<const Interval> box, std::span<const Decision> decisions,
                         std::span<const NodeId> which) {
  turned_ = which;
  const BoxResult result = evaluate(box, decisions);
  turned_ = {};
  if (result.isImpossible) return 0;
  bool isAnyTurned = false;
  double jump = 0;
  for (const NodeId id : which) {
    if (!isTurned(id)) continue;
    isAnyTurned = true;
    const Slot& slot = slots_[id];
    if (isStep(graph_[id].op) && slot.isLive) {
      const Interval steps = stepped(graph_[id].op, slots_[graph_[id].operands[0]].between);
      jump += productUp(steps.width(), slot.adjoint.magnitude());
    }
  }
  if (!isAnyTurned) return 0;
  for (const NodeId id : order_) {
    const Node& node = graph_[id];
    const Slot& slot = slots_[id];
    if (node.op != Op::Select || !slot.isLive || slots_[node.operands[0]].truth != Decision::Open) continue;
    const Interval change = slots_[node.operands[1]].exact - slots_[node.operands[2]].exact;
    jump += productUp(change.magnitude(), slot.adjoint.magnitude());
  }
  if (result.problem != Problem::None) return infinity;
  return roundedUp(jump, 0x1p-40);
}

}  // namespace skc::bounds
