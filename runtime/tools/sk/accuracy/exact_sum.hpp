// SPDX-License-Identifier: MIT
//
// Sums of doubles on the host that lose nothing until they are read: expansions (Shewchuk, Discrete & Computational
// Geometry 18, 1997, section 2.4).
#pragma once

#include <cmath>
#include <utility>
#include <vector>

namespace sk_tool {

class ExactSum {
 public:
  /// A number that is finite, as all partial sums must be. The product of two floats is such a number without rounding.
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

  /// The sum, off by an ulp at most.
  double value() const {
    double sum = 0;
    for (const double part : parts_) sum += part;
    return sum;
  }

  /// |x - sum|, likewise.
  double distance(double x) const {
    ExactSum difference = *this;
    difference.add(-x);
    return std::fabs(difference.value());
  }

 private:
  std::vector<double> parts_;  // from the smallest on, none overlapping another
};

}  // namespace sk_tool
