// SPDX-License-Identifier: MIT
//
// Tables that replace functions. A .sk file declares one with [[table(lo, hi, n, linear)]] in front of a
// function of one float (docs/language.md); a configuration file may give it another range.
#pragma once

#include <cstdint>
#include <string>

namespace sk {

enum class Interpolation : std::uint8_t {
  Linear,  ///< between the values at the ends of an interval
  Cubic,  ///< cubic Hermite: matches values and slopes at both ends
};

/// The range of a table. Arguments outside are clamped to it.
struct TableRange {
  float low = 0;
  float high = 1;
  std::int32_t intervals = 0;  ///< 1 to mostIntervals, of equal length

  bool operator==(const TableRange&) const = default;
};
inline constexpr std::int32_t mostIntervals = 1 << 20;

/// A table as built, with its error.
struct TableReport {
  std::string function;  ///< qualified, as in the .sk file
  TableRange range;
  Interpolation interpolation;
  /// A bound of the absolute error of every lookup in the range, against the function in double: from irregular samples,
  /// more of them where the function bends, and from the rounding of the argument and of the result.
  double predicted;
  /// Largest absolute error found by looking up eight arguments per interval, and at least 4096, in float arithmetic.
  double measured;
  float worst;  ///< the argument of the largest error found
};

}  // namespace sk
