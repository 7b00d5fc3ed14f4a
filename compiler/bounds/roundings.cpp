// SPDX-License-Identifier: MIT
//
// What a device's operations add to the error, and the numbers that they can give.
#include "bounds/evaluator.hpp"

#include <algorithm>
#include <cmath>

namespace skc::bounds {
namespace {

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
      if (y.contains(0)) return Interval::whole();
      return ends(x.low / y.low, x.low / y.high, x.high / y.low, x.high / y.high);
    default: return Interval::whole();
  }
}

/// True where the difference of two numbers of a format is one, too (Sterbenz 1974).
bool isDifferenceExact(Interval x, Interval y) {
  if (x.high < 0 && y.high < 0) return isDifferenceExact(-x, -y);
  return x.low > 0 && y.low > 0 && y.high <= 2 * x.low && x.high <= 2 * y.low;
}

}  // namespace

/// The values of a Min or Max on the way from the exact numbers to the computed ones.
Interval Evaluator::extremeOf(const Node& node) const {
  const Interval x = slots_[node.operands[0]].between, y = slots_[node.operands[1]].between;
  return node.op == Op::Min ? smaller(x, y) : larger(x, y);
}

/// A bound on what errors of operands change the result by, other than by derivatives; infinity if there is none.
double Evaluator::directErrorOf(const Node& node, const Slot& slot, double propagated) const {
  if (node.op == Op::Min || node.op == Op::Max) {
    const Interval values = hull(slot.exact, extremeOf(node));
    return roundedUp(values.width());
  }
  double direct = infinity;
  if (node.op != Op::Call) return direct;
  const Slot& x = slots_[node.operands[0]];
  if (x.error == 0) return direct;
  // |sqrt(a) - sqrt(b)| is at most sqrt(|a - b|).
  if (node.function == UnaryFunction::Sqrt) direct = roundedUp(std::sqrt(x.error));
  if (!(propagated < infinity)) {
    const Interval values = valueOf(node.function, hull(x.exact, x.computed));
    direct = std::min(direct, roundedUp(values.width()));
  }
  return direct;
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
    if (rounding.isGrowing) return lost;
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
    error = power == format.smallest
                ? format.unit * power
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

/// The range of computed values of an operation whose error is a part of the result: it changes no sign.
Interval Evaluator::withSigns(Interval range, const Node& node) const {
  const Interval x = slots_[node.operands[0]].computed, y = slots_[node.operands[1]].computed;
  const Interval result = node.op == Op::Add                     ? x + y
                          : node.op == Op::Subtract              ? x - y
                          : node.op == Op::Divide                ? x / y
                          : node.operands[0] == node.operands[1] ? square(x)
                                                                 : x * y;
  if (result.low >= 0) range.low = std::max(range.low, 0.0);
  if (result.high <= 0) range.high = std::min(range.high, 0.0);
  return range;
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
      if (rounding.kind != Rounding::Kind::Nearest || rounding.format.isRelative)
        return withSigns(range, node);
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

}  // namespace skc::bounds
