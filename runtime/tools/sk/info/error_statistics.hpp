// SPDX-License-Identifier: MIT
//
// Errors in units in the last place, reported as in the GPU floating-point paranoia (Hillesland and Lastra,
// 2004): the signed interval, and the largest and the mean magnitude.
#pragma once

#include <cstddef>

#include "info/device_info.hpp"

namespace sk_tool {

/// The distance between floats at a number: 2^-149 for subnormal numbers.
double ulpOf(double number);

/// `value` rounded to three significant digits, so that figures of one run have one format.
double rounded(double value);

class ErrorStatistics {
 public:
  /// `reference` must be in the range of floats.
  void add(float got, double reference, double argument);

  /// "max", "mean", "min_signed" and "max_signed" in ulp, "max_absolute", "worst_at" (the argument) and
  /// "not_finite" (the number of results that are not finite, which are excluded from the others).
  Json json() const;
  double max() const { return max_; }

 private:
  std::size_t count_ = 0;
  std::size_t notFinite_ = 0;
  double sum_ = 0, max_ = 0, least_ = 0, most_ = 0, maxAbsolute_ = 0, worstAt_ = 0;
};

}  // namespace sk_tool
