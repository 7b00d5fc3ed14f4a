// SPDX-License-Identifier: MIT
//
// The values of expressions as index analysis sees them: the range of each int, and what all others depend on.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/index_range.hpp"
#include "ir/ir.hpp"

namespace skc::analysis {

/// What a value depends on, beside constants and uniforms: a set of bits.
enum Depends : std::uint8_t { OnNothing = 0, OnElement = 1, OnData = 2 };

/// A scalar.
struct IndexValue {
  bool isSet = false;  ///< false for a variable that has no value yet
  std::uint8_t depends = OnNothing;
  std::optional<IndexRange> range = {};  ///< of ints and uints, if anything is known
  bool operator==(const IndexValue&) const = default;
};

/// One for each scalar leaf of a type, as in shapes.hpp: the elements of an array share the leaves of one.
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
