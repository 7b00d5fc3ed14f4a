// SPDX-License-Identifier: MIT
//
// The largest errors of sums that are not exact, as docs/accuracy.md states them under "Sums" (Higham, Accuracy and Stability of
// Numerical Algorithms, section 4.2; Ogita, Rump and Oishi 2005 for compensated sums and dot products). `sk accuracy` and the
// tests read them from here.
#pragma once

#include <algorithm>
#include <cmath>

#include "sk/options.hpp"

namespace sk {

/// How a device adds.
struct SummingDevice {
  bool isNative = false;
  bool flushesDenormals = false;  ///< may take denormal numbers as 0
  bool hasPairs = false;  ///< doubles are pairs of floats
  bool isDispatched = false;  ///< has compute programs
  int ranks = 1;  ///< that share a stream
};

/// What the error of a sum depends on.
struct SumFacts {
  Accumulate accumulate = Accumulate::Compensated;
  Precision precision = Precision::Single;
  bool isScan = false;
  double elements = 0;
  double terms = 0;  ///< of all elements
  double magnitude = 0;  ///< sum of the magnitudes of the terms
  double sum = 0;
  bool areDoubles = false;  ///< the accumulator is a double

  /// Partial results have more bits than floats.
  bool isWide() const {
    return precision == Precision::Double || precision == Precision::Extended ||
           accumulate == Accumulate::Extended;
  }
};

/// The most additions that a term takes part in: docs/accuracy.md, Sums.
inline double depthOfSum(const SumFacts& facts, const SummingDevice& device) {
  const double n = std::max(facts.elements, 2.0), runs = std::ceil(std::log2(n) / std::log2(30.0));
  double depth = 8 + 31 * runs;
  if (device.isNative) {
    depth = facts.isScan ? n : 24 + std::log2(n);
  } else if (facts.isScan) {
    depth = 64 * runs;
  } else if (device.isDispatched && n >= 512) {
    depth = 518 + 31 * runs;
  }
  return depth * std::max(facts.terms / n, 1.0) + device.ranks - 1;
}

/// The largest error of a sum that is not exact.
inline double boundOfSum(const SumFacts& facts, const SummingDevice& device) {
  constexpr double u = 0x1p-24;
  // Each rank before this one rounds a scan twice more (docs/domains.md).
  const double ofRanks = facts.isScan && device.ranks > 1 ? 2.0 * device.ranks : 0;
  const double depth = depthOfSum(facts, device) + 1;  // a product is rounded, too
  if (facts.areDoubles) return (depth + ofRanks) * (device.hasPairs ? 0x1p-44 : 0x1p-53) * facts.magnitude;
  const double lost =
      facts.terms * (device.flushesDenormals ? 0x1p-122 : 0x1p-149) + ofRanks * u * facts.magnitude;
  if (facts.accumulate == Accumulate::Tree && !facts.isWide()) return lost + depth * u * facts.magnitude;
  const double own = lost + u * std::fabs(facts.sum);
  if (facts.precision == Precision::Double) return own + depth * 0x1p-53 * facts.magnitude;
  if (facts.isWide()) return own + depth * 0x1p-44 * facts.magnitude;
  return own + 2 * depth * depth * u * u * facts.magnitude;
}

}  // namespace sk
