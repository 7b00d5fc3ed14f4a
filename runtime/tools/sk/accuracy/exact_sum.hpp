// SPDX-License-Identifier: MIT
//
// Exact sums of doubles on the host, rounded only when read: expansions (Shewchuk, Discrete & Computational
// Geometry 18, 1997, section 2.4).
#pragma once

#include <cmath>
#include <utility>
#include <vector>

namespace sk_tool {

class ExactSum {
 public:
  /// Adds a number. All partial sums must be finite. A double represents the product of two floats exactly.
  void add(double x) {
    std::size_t kept = 0;
    for (double part : parts_) {
      if (std::fabs(x) < std::fabs(part)) std::swap(x, part);
      const double sum = x + part;
      const double lost = part - (sum - x);
      if (lost != 0) parts_[kept++] = lost;
      x = sum;
    }
    parts_.resize(kept);
    parts_.push_back(x);
  }

  /// The sum, with an error of at most one ulp.
  double value() const {
    double sum = 0;
    for (const double part : parts_) sum += part;
    return sum;
  }

  /// x - sum|, with the same error.
  double distance(double x) const {
    ExactSum difference = *this;
    difference.add(-x);
    return std::fabs(difference.value());
  }

 private:
  std::vector<double> parts_;  // in increasing order, without overlap
};

}  // namespace sk_tool
