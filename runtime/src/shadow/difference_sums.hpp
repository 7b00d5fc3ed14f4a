// SPDX-License-Identifier: MIT
//
// Sums over the differences of three arrays of doubles, with the widest vectors of the CPU: most of the time of a comparison.
#pragma once

#include <cstdint>

namespace sk::shadow {

/// What addDifferences() finds in arrays d, o and r (errors.hpp).
struct DifferenceSums {
  double reference2 = 0;  ///< sum of r * r
  double own2 = 0;  ///< sum of (d - o)^2
  double inherited2 = 0;  ///< sum of (o - r)^2
  double total2 = 0;  ///< sum of (d - r)^2
  double largestOwn = 0;  ///< largest |d - o|
  bool mayFlush = false;  ///< somewhere, d is 0 and o is not

  /// False if an element of an array is NaN or infinite, or if sums overflow: then nothing else is valid.
  bool isFinite() const;
  /// The sum of (d - o)(d - r).
  double ownInTotal() const { return 0.5 * (own2 + total2 - inherited2); }
};

/// The sums over `count` elements. Their rounding depends on the CPU.
DifferenceSums addDifferences(const double* d, const double* o, const double* r, std::int64_t count);

}  // namespace sk::shadow
