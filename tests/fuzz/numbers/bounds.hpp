// SPDX-License-Identifier: MIT
//
// What docs/accuracy.md promises: the largest errors of functions, in units in the last place, and of sums.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "sk/error_bounds.hpp"
#include "sk/options.hpp"

namespace fuzz::numbers {

/// How a device computes, as far as promises depend on it.
struct Arithmetic {
  bool isNative = false;
  bool flushesDenormals = false;  ///< may take denormal numbers as 0
  bool hasPairs = false;  ///< doubles are pairs of floats
  int ranks = 1;  ///< that share a stream
};

/// The largest error of a function, in the units of sk::ErrorBound: what runtime/include/sk/error_bounds.def has, or, of what it leaves out,
/// docs/accuracy.md.
inline double boundOf(std::string_view name, sk::BoundedType type, bool isNative) {
  const sk::ErrorBound* bound =
      sk::errorBoundOf(name, type, isNative ? sk::BoundedCode::Native : sk::BoundedCode::Glsl);
  if (bound != nullptr) return bound->bound;
  if (name == "length") return 2;
  if (name == "normalize") return 3;
  return 2.5;  // sqrt and inversesqrt of devices with GL
}

/// What the error of a sum depends on.
struct SumFacts {
  sk::Accumulate accumulate = sk::Accumulate::Compensated;
  sk::Precision precision = sk::Precision::Single;
  bool isScan = false;
  double elements = 0;
  double terms = 0;  ///< of all elements
  double magnitude = 0;  ///< sum of the magnitudes of the terms
  double sum = 0;
  bool areDoubles = false;  ///< the accumulator is a double
  bool areProducts = false;
};

/// The largest error of a sum that is not exact.
inline double boundOf(const SumFacts& facts, const Arithmetic& arithmetic) {
  constexpr double u = 0x1p-24;
  // An element adds its terms one after the other, and the elements form a tree.
  // A native scan adds elements one after the other.
  const bool isSequential = facts.isScan && arithmetic.isNative;
  const double ofElement = std::max(1.0, facts.terms / std::max(1.0, facts.elements));
  const double depth = isSequential ? facts.terms + 1 : std::log2(std::max(2.0, facts.elements)) + ofElement;
  // Each rank before rounds twice more (docs/domains.md).
  const double ofRanks = facts.isScan && arithmetic.ranks > 1 ? 2.0 * arithmetic.ranks : 0;
  if (facts.areDoubles) {
    const double unit = arithmetic.hasPairs ? 0x1p-44 : 0x1p-53;
    return (facts.terms + ofRanks) * unit * facts.magnitude;
  }
  const double own = ofRanks * u * facts.magnitude + u * std::fabs(facts.sum) +
                     (arithmetic.flushesDenormals ? 0x1p-126 : 0x1p-150);
  if (facts.precision == sk::Precision::Extended || facts.precision == sk::Precision::Double ||
      facts.accumulate == sk::Accumulate::Extended)
    return own + 0x1p-44 * depth * facts.magnitude;
  if (facts.accumulate == sk::Accumulate::Tree) return own + u * depth * facts.magnitude;
  return own + depth * depth * u * u * facts.magnitude;
}

}  // namespace fuzz::numbers
