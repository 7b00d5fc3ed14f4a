// SPDX-License-Identifier: MIT
//
// What is known of an integer's value: bounds, and bounds of its distance from each component of the index of the
// element that is computed. A bound is a constant plus multiples of Spec parameters, so that it is the same for all
// elements. This is interval analysis (P. Cousot and R. Cousot, "Abstract interpretation", 1977) of five differences
// at once. Integer arithmetic is taken not to overflow. The end of the file states what is known of all values at one point.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc::analysis {

/// The number of dimensions that an index has.
inline constexpr std::size_t dimensions = 4;

/// An upper bound; nullopt if none is known.
using Upper = std::optional<ir::Distance>;

/// The values x with x <= high and -x <= negatedLow.
struct Interval {
  Upper high, negatedLow;
  bool isBounded() const { return high && negatedLow; }
  bool operator==(const Interval&) const = default;
};

Interval exactly(std::int64_t value);
Interval between(std::int64_t low, std::int64_t high);
Interval atLeast(std::int64_t low);
/// The value, if both bounds are this constant.
std::optional<std::int64_t> constantOf(const Interval& interval);

/// An integer. Every bound holds; none follows from another.
struct IndexRange {
  Interval value;
  std::array<Interval, dimensions> fromElement;  ///< value minus this component of the element's index
  /// The bounds hold if the kernel's parameters of these bits have the domain's extents.
  std::uint64_t shapes = 0;
  bool operator==(const IndexRange&) const = default;
};

/// What is known of the element's index itself, for each component.
using ElementBounds = std::array<Interval, dimensions>;

IndexRange rangeOf(const Interval& value);
/// A component of the element's index, and the extent of the domain in that dimension.
IndexRange elementIndex(std::size_t dimension);
IndexRange domainExtent(std::size_t dimension);

IndexRange sum(const IndexRange& a, const IndexRange& b);
IndexRange difference(const IndexRange& a, const IndexRange& b);
IndexRange product(const IndexRange& a, const IndexRange& b);
IndexRange quotient(const IndexRange& a, const IndexRange& b);
IndexRange remainder(const IndexRange& a, const IndexRange& b);
IndexRange bitAnd(const IndexRange& a, const IndexRange& b);
IndexRange smaller(const IndexRange& a, const IndexRange& b);
IndexRange larger(const IndexRange& a, const IndexRange& b);
/// One of the two.
IndexRange either(const IndexRange& a, const IndexRange& b);
/// `last` without the bounds that `next` exceeds.
IndexRange widened(const IndexRange& last, const IndexRange& next);

/// `range`, given that its value is at most `bound` - `gap`, or at least `bound` + `gap`.
IndexRange atMost(const IndexRange& range, const IndexRange& bound, std::int64_t gap);
IndexRange atLeast(const IndexRange& range, const IndexRange& bound, std::int64_t gap);

/// `range` with the bounds that follow from those of the element's index; and the reverse.
IndexRange seenFrom(const ElementBounds& element, const IndexRange& range);
ElementBounds learned(ElementBounds element, const IndexRange& range);

// The values of expressions as index analysis sees them: the range of each int, and what all others depend on.

/// What a value depends on, beside constants and uniforms: a set of bits.
enum Depends : std::uint8_t { OnNothing = 0, OnElement = 1, OnData = 2 };

/// A scalar.
struct IndexValue {
  bool isSet = false;  ///< false for a variable that has no value yet
  std::uint8_t depends = OnNothing;
  std::optional<IndexRange> range = {};  ///< of ints and uints, if anything is known
  bool operator==(const IndexValue&) const = default;
};

/// The values of all scalar leaves of a type (shapes.hpp). All elements of an array share the leaves of one element.
using IndexValues = std::vector<IndexValue>;

/// What is known at one point of a function.
struct IndexState {
  std::vector<IndexValues> variables;
  ElementBounds element;
  bool isReachable = true;
  bool operator==(const IndexState&) const = default;
};

/// Adds what is known where control flow comes from `from`.
void join(IndexState& into, const IndexState& from);
/// The value that is one of the two, each in its state.
IndexValue joined(const ElementBounds& here, const IndexValue& a, const ElementBounds& there,
                  const IndexValue& b);
/// Drops the bounds of `next` that are wider than in `last`, so that a loop's analysis ends.
void widen(const IndexState& last, IndexState& next);

}  // namespace skc::analysis
