// SPDX-License-Identifier: MIT
//
// Tables that stand for functions: a .sk file declares one with [[table(lo, hi, n, linear)]] in front of a function of one
// float (docs/language.md), a configuration file may give it another range.
#pragma once

#include <cstdint>
#include <string>

namespace sk {

enum class Interpolation : std::uint8_t {
  Linear,  ///< between the values at an interval's ends
  Cubic,  ///< the polynomial with the values and the slopes at both ends (Hermite's)
};

/// The range of a table. An argument outside is taken for the nearer end.
struct TableRange {
  float low = 0;
  float high = 1;
  std::int32_t intervals = 0;  ///< 1 to mostIntervals, of equal length

  bool operator==(const TableRange&) const = default;
};
inline constexpr std::int32_t mostIntervals = 1 << 20;

/// A table as it was built, and what it costs in accuracy.
struct TableReport {
  std::string function;  ///< qualified, as in the .sk file
  TableRange range;
  Interpolation interpolation;
  /// Largest error over the range, absolute: from the largest differences of the function's values, with what floats
  /// lose of the argument and the result.
  double predicted;
  /// Likewise, found by looking up eight arguments in each interval with float arithmetic.
  double measured;
  float worst;  ///< the argument of the largest error found
};

}  // namespace sk
