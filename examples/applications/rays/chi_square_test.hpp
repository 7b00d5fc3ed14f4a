// SPDX-License-Identifier: MIT
//
// Pearson's chi-square test of counts against the counts that a density predicts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace rays {

/// How many standard deviations chi square is above its mean, by the cube root that makes it nearly normal (E. Wilson and M. Hilferty, 1931).
/// `expected` are probabilities. What they lack to 1 is one more bin, and bins with fewer than 5 expected counts are merged into one. Infinite if
/// an impossible bin has counts.
inline double chiSquareDeviation(const std::vector<double>& counts, const std::vector<double>& expected) {
  const double n = std::accumulate(counts.begin(), counts.end(), 0.0);
  double chiSquare = 0.0, restCount = 0.0, restExpected = 0.0;
  int bins = 0;
  const auto add = [&](double count, double e) {
    chiSquare += (count - e) * (count - e) / e;
    ++bins;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (n * expected[i] >= 5) {
      add(counts[i], n * expected[i]);
    } else {
      restCount += counts[i];
      restExpected += n * expected[i];
    }
  }
  if (restExpected >= 5)
    add(restCount, restExpected);
  else if (restCount > 30)
    return HUGE_VAL;
  const double k = bins - 1, spread = 2 / (9 * k);
  return (std::cbrt(chiSquare / k) - (1 - spread)) / std::sqrt(spread);
}

/// Counts in equal bins of the unit square.
class SquareBins {
 public:
  explicit SquareBins(int side)
      : side_(side), counts_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

  /// Points outside the square count in the nearest bin.
  void add(double x, double y) {
    const auto bin = [&](double c) { return std::clamp(static_cast<int>(c * side_), 0, side_ - 1); };
    ++counts_[static_cast<std::size_t>(bin(y) * side_ + bin(x))];
  }
  const std::vector<double>& counts() const { return counts_; }
  double deviationFromUniform() const {
    return chiSquareDeviation(counts_, std::vector<double>(counts_.size(), 1.0 / double(counts_.size())));
  }

 private:
  int side_;
  std::vector<double> counts_;
};

}  // namespace rays
