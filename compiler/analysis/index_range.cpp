// SPDX-License-Identifier: MIT
#include "analysis/index_range.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace skc::analysis {
namespace {

using ir::Distance;

/// A larger bound is none: no stream has so many elements in a dimension.
constexpr std::int64_t largest = std::int64_t{1} << 31;

Upper constant(std::int64_t value) {
  return std::abs(value) <= largest ? Upper(Distance{value}) : std::nullopt;
}

/// a + times * b, for a `times` of at least 0.
Upper sum(const Upper& a, const Upper& b, std::int64_t times = 1) {
  if (times == 0) return a;
  if (!a || !b || times > largest) return std::nullopt;
  Distance result{a->constant + times * b->constant};
  if (std::abs(result.constant) > largest) return std::nullopt;
  for (std::size_t s = 0; s < result.perSpec.size(); ++s) {
    const std::int64_t factor = a->perSpec[s] + times * b->perSpec[s];
    if (std::abs(factor) > std::numeric_limits<std::int16_t>::max()) return std::nullopt;
    result.perSpec[s] = static_cast<std::int16_t>(factor);
  }
  return result;
}

bool isConstant(const Upper& bound) { return bound->perSpec == Distance().perSpec; }

/// A bound of what both bound: the lower one, or a constant where that cannot be known.
Upper tighter(const Upper& a, const Upper& b) {
  if (!a || !b) return a ? a : b;
  if (a->perSpec == b->perSpec) return a->constant <= b->constant ? a : b;
  return isConstant(b) && !isConstant(a) ? b : a;
}

/// A bound of what either bounds.
Upper looser(const Upper& a, const Upper& b) {
  if (!a || !b || a->perSpec != b->perSpec) return std::nullopt;
  return a->constant >= b->constant ? a : b;
}

Interval negated(const Interval& a) { return {a.negatedLow, a.high}; }
Interval sum(const Interval& a, const Interval& b) {
  return {sum(a.high, b.high), sum(a.negatedLow, b.negatedLow)};
}
Interval tighter(const Interval& a, const Interval& b) {
  return {tighter(a.high, b.high), tighter(a.negatedLow, b.negatedLow)};
}
Interval looser(const Interval& a, const Interval& b) {
  return {looser(a.high, b.high), looser(a.negatedLow, b.negatedLow)};
}
Interval scaled(const Interval& a, std::int64_t times) {
  const Interval& from = times < 0 ? negated(a) : a;
  const Upper zero = constant(0);
  return {sum(zero, from.high, std::abs(times)), sum(zero, from.negatedLow, std::abs(times))};
}

/// The bounds, if both are constants.
struct Ends {
  std::int64_t low, high;
};
std::optional<Ends> endsOf(const Interval& a) {
  if (!a.isBounded() || !isConstant(a.high) || !isConstant(a.negatedLow)) return std::nullopt;
  return Ends{-a.negatedLow->constant, a.high->constant};
}

bool isNonNegative(const Interval& a) {
  return a.negatedLow && isConstant(a.negatedLow) && a.negatedLow->constant <= 0;
}

/// combine(x, y) of the two values, and of their distances from each component of the element's index.
template <class Combine>
IndexRange eachBound(const IndexRange& a, const IndexRange& b, const Combine& combine) {
  IndexRange result{combine(a.value, b.value), {}, a.shapes | b.shapes};
  for (std::size_t d = 0; d < dimensions; ++d)
    result.fromElement[d] = combine(a.fromElement[d], b.fromElement[d]);
  return result;
}

/// Without assumptions where they serve no bound.
IndexRange trimmed(IndexRange range) {
  const auto isOpen = [](const Interval& one) { return !one.high && !one.negatedLow; };
  if (isOpen(range.value) && std::ranges::all_of(range.fromElement, isOpen)) range.shapes = 0;
  return range;
}

}  // namespace

Interval exactly(std::int64_t value) { return between(value, value); }
Interval between(std::int64_t low, std::int64_t high) { return {constant(high), constant(-low)}; }
Interval atLeast(std::int64_t low) { return {std::nullopt, constant(-low)}; }

std::optional<std::int64_t> constantOf(const Interval& interval) {
  const std::optional<Ends> ends = endsOf(interval);
  return ends && ends->low == ends->high ? std::optional(ends->low) : std::nullopt;
}

IndexRange rangeOf(const Interval& value) { return {value, {}}; }

IndexRange elementIndex(std::size_t dimension) {
  IndexRange result = rangeOf(atLeast(0));
  result.fromElement[dimension] = exactly(0);
  return result;
}

IndexRange domainExtent(std::size_t dimension) {
  IndexRange result = rangeOf(atLeast(1));
  result.fromElement[dimension] = atLeast(1);
  return result;
}

IndexRange sum(const IndexRange& a, const IndexRange& b) {
  IndexRange result{sum(a.value, b.value), {}, a.shapes | b.shapes};
  for (std::size_t d = 0; d < dimensions; ++d) {
    result.fromElement[d] = tighter(sum(a.fromElement[d], b.value), sum(a.value, b.fromElement[d]));
  }
  return trimmed(result);
}

IndexRange difference(const IndexRange& a, const IndexRange& b) {
  IndexRange result{sum(a.value, negated(b.value)), {}, a.shapes | b.shapes};
  for (std::size_t d = 0; d < dimensions; ++d) {
    result.value = tighter(result.value, sum(a.fromElement[d], negated(b.fromElement[d])));
    result.fromElement[d] = sum(a.fromElement[d], negated(b.value));
  }
  return trimmed(result);
}

IndexRange product(const IndexRange& a, const IndexRange& b) {
  const std::optional<std::int64_t> left = constantOf(a.value), right = constantOf(b.value);
  if (left == 1 || right == 1) return left == 1 ? b : a;
  const std::uint64_t shapes = a.shapes | b.shapes;
  if (left || right) return {scaled(left ? b.value : a.value, left ? *left : *right), {}, shapes};
  const std::optional<Ends> x = endsOf(a.value), y = endsOf(b.value);
  if (x && y) {
    const auto [low, high] =
        std::minmax({x->low * y->low, x->low * y->high, x->high * y->low, x->high * y->high});
    return {between(low, high), {}, shapes};
  }
  return rangeOf(isNonNegative(a.value) && isNonNegative(b.value) ? atLeast(0) : Interval());
}

IndexRange quotient(const IndexRange& a, const IndexRange& b) {
  const std::optional<std::int64_t> by = constantOf(b.value);
  if (!by || *by <= 0) return {};
  const auto divided = [&](const Upper& bound) {
    return bound && isConstant(bound) ? constant(bound->constant / *by) : std::nullopt;
  };
  return trimmed({{divided(a.value.high), divided(a.value.negatedLow)}, {}, a.shapes});
}

IndexRange remainder(const IndexRange& a, const IndexRange& b) {
  const std::optional<std::int64_t> by = constantOf(b.value);
  if (!by || *by == 0) return rangeOf(isNonNegative(a.value) ? atLeast(0) : Interval());
  const std::int64_t most = std::abs(*by) - 1;
  return {between(isNonNegative(a.value) ? 0 : -most, most), {}, a.shapes};
}

IndexRange bitAnd(const IndexRange& a, const IndexRange& b) {
  const std::optional<std::int64_t> left = constantOf(a.value), right = constantOf(b.value);
  const std::optional<std::int64_t> mask = left ? left : right;
  return mask && *mask >= 0 ? rangeOf(between(0, *mask)) : IndexRange();
}

IndexRange smaller(const IndexRange& a, const IndexRange& b) {
  return trimmed(eachBound(a, b, [](const Interval& x, const Interval& y) {
    return Interval{tighter(x.high, y.high), looser(x.negatedLow, y.negatedLow)};
  }));
}

IndexRange larger(const IndexRange& a, const IndexRange& b) {
  return trimmed(eachBound(a, b, [](const Interval& x, const Interval& y) {
    return Interval{looser(x.high, y.high), tighter(x.negatedLow, y.negatedLow)};
  }));
}

IndexRange either(const IndexRange& a, const IndexRange& b) {
  return trimmed(eachBound(a, b, [](const Interval& x, const Interval& y) { return looser(x, y); }));
}

IndexRange widened(const IndexRange& last, const IndexRange& next) {
  const auto kept = [](const Upper& old, const Upper& now) {
    return old && looser(old, now) == old ? old : std::nullopt;
  };
  return trimmed(eachBound(last, next, [&](const Interval& x, const Interval& y) {
    return Interval{kept(x.high, y.high), kept(x.negatedLow, y.negatedLow)};
  }));
}

IndexRange atMost(const IndexRange& range, const IndexRange& bound, std::int64_t gap) {
  IndexRange result = range;
  const auto limit = [&](Interval& to, const Interval& by) {
    to.high = tighter(to.high, sum(by.high, constant(-gap)));
  };
  limit(result.value, bound.value);
  for (std::size_t d = 0; d < dimensions; ++d) limit(result.fromElement[d], bound.fromElement[d]);
  if (result != range) result.shapes |= bound.shapes;
  return result;
}

IndexRange atLeast(const IndexRange& range, const IndexRange& bound, std::int64_t gap) {
  IndexRange result = range;
  const auto limit = [&](Interval& to, const Interval& by) {
    to.negatedLow = tighter(to.negatedLow, sum(by.negatedLow, constant(-gap)));
  };
  limit(result.value, bound.value);
  for (std::size_t d = 0; d < dimensions; ++d) limit(result.fromElement[d], bound.fromElement[d]);
  if (result != range) result.shapes |= bound.shapes;
  return result;
}

IndexRange seenFrom(const ElementBounds& element, const IndexRange& range) {
  IndexRange result = range;
  for (std::size_t d = 0; d < dimensions; ++d) {
    result.fromElement[d] = tighter(range.fromElement[d], sum(range.value, negated(element[d])));
  }
  return result;
}

ElementBounds learned(ElementBounds element, const IndexRange& range) {
  if (range.shapes != 0) return element;
  for (std::size_t d = 0; d < dimensions; ++d) {
    element[d] = tighter(element[d], sum(range.value, negated(range.fromElement[d])));
  }
  return element;
}

IndexValue joined(const ElementBounds& here, const IndexValue& a, const ElementBounds& there,
                  const IndexValue& b) {
  if (!a.isSet || !b.isSet) return a.isSet ? a : b;
  if (a == b) return a;
  IndexValue result{true, static_cast<std::uint8_t>(a.depends | b.depends)};
  if (a.range && b.range) result.range = either(seenFrom(here, *a.range), seenFrom(there, *b.range));
  return result;
}

void join(IndexState& into, const IndexState& from) {
  if (!from.isReachable) return;
  if (!into.isReachable) {
    into = from;
    return;
  }
  for (std::size_t v = 0; v < into.variables.size(); ++v) {
    for (std::size_t i = 0; i < into.variables[v].size(); ++i) {
      IndexValue& value = into.variables[v][i];
      value = joined(into.element, value, from.element, from.variables[v][i]);
    }
  }
  for (std::size_t d = 0; d < dimensions; ++d) {
    into.element[d] = either(rangeOf(into.element[d]), rangeOf(from.element[d])).value;
  }
}

void widen(const IndexState& last, IndexState& next) {
  for (std::size_t v = 0; v < next.variables.size(); ++v) {
    for (std::size_t i = 0; i < next.variables[v].size(); ++i) {
      const IndexValue& old = last.variables[v][i];
      IndexValue& value = next.variables[v][i];
      if (!old.isSet) continue;
      if (!old.range || !value.range) {
        value.range.reset();
      } else {
        value.range = widened(*old.range, *value.range);
      }
    }
  }
  for (std::size_t d = 0; d < dimensions; ++d)
    next.element[d] = widened(rangeOf(last.element[d]), rangeOf(next.element[d])).value;
}

}  // namespace skc::analysis
