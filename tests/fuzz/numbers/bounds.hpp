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
  bool isDispatched = false;  ///< has compute programs
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

  /// Partial results have more bits than floats.
  bool isWide() const {
    return precision == sk::Precision::Double || precision == sk::Precision::Extended ||
           accumulate == sk::Accumulate::Extended;
  }
};

/// The most additions that a term takes part in: docs/accuracy.md, Sums.
inline double depthOf(const SumFacts& facts, const Arithmetic& arithmetic) {
  const double n = std::max(facts.elements, 2.0), runs = std::ceil(std::log2(n) / std::log2(30.0));
  double depth = 8 + 31 * runs;
  if (arithmetic.isNative) {
    depth = facts.isScan ? n : 24 + std::log2(n);
  } else if (facts.isScan) {
    depth = 64 * runs;
  } else if (arithmetic.isDispatched && n >= 512) {
    depth = 518 + 31 * runs;
  }
  return depth * std::max(facts.terms / n, 1.0) + arithmetic.ranks - 1;
}

/// The largest error of a sum that is not exact.
inline double boundOf(const SumFacts& facts, const Arithmetic& arithmetic) {
  constexpr double u = 0x1p-24;
  // Each rank before this one rounds a scan twice more (docs/domains.md).
  const double ofRanks = facts.isScan && arithmetic.ranks > 1 ? 2.0 * arithmetic.ranks : 0;
  const double depth = depthOf(facts, arithmetic) + 1;  // a product is rounded, too
  if (facts.areDoubles)
    return (depth + ofRanks) * (arithmetic.hasPairs ? 0x1p-44 : 0x1p-53) * facts.magnitude;
  const double lost =
      facts.terms * (arithmetic.flushesDenormals ? 0x1p-122 : 0x1p-149) + ofRanks * u * facts.magnitude;
  if (facts.accumulate == sk::Accumulate::Tree && !facts.isWide()) return lost + depth * u * facts.magnitude;
  const double own = lost + u * std::fabs(facts.sum);
  if (facts.precision == sk::Precision::Double) return own + depth * 0x1p-53 * facts.magnitude;
  if (facts.isWide()) return own + depth * 0x1p-44 * facts.magnitude;
  return own + 2 * depth * depth * u * u * facts.magnitude;
}

}  // namespace fuzz::numbers
