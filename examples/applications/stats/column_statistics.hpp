// SPDX-License-Identifier: MIT
//
// What is asked of a column, and the two ways to the answers: reductions on a device, and a plain loop in
// double precision that checks them.
#pragma once

#include <cstdint>
#include <span>

#include <sk/device.hpp>

#include "support/verification.hpp"

namespace examples {

struct ColumnStatistics {
  std::int64_t count = 0;    ///< numbers that are there
  std::int64_t missing = 0;
  double mean = 0.0;         ///< NaN of no number
  double variance = 0.0;     ///< unbiased; NaN of less than two numbers
  float min = 0.0f;
  float max = 0.0f;
  std::int64_t argmax = -1;  ///< the first place of the greatest; -1 of no number
  double centre = 0.0;       ///< what deviations were taken from: the mean, rounded by the device
};

/// Two passes (T. Chan, G. Golub, R. LeVeque, "Algorithms for computing the sample variance", 1983, section
/// 3): the mean first, then deviations from it and their squares, where the sum of the deviations mends both
/// the mean and the variance.
ColumnStatistics reduceColumn(sk::Device& device, std::span<const float> values);

/// The same by double loops.
ColumnStatistics loopOver(std::span<const float> values);

/// How far the device is from the loop over all columns.
struct StatisticsChecks {
  explicit StatisticsChecks(std::int64_t rows);
  void compare(std::span<const float> values, const ColumnStatistics& device, std::int64_t column);

  Verification exact;      ///< counts, least, greatest and its place
  Verification means;      ///< relative to the mean deviation from the device's centre
  Verification variances;  ///< relative to the mean square of that deviation
};

}  // namespace examples
