// SPDX-License-Identifier: MIT
//
// Draws numbers to add, from a fixed seed: easy ones, and ones that cancel. Their exact sums of doubles are expansions,
// rounded only when read (Shewchuk, Discrete & Computational Geometry 18, 1997, section 2.4).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace sk_tool {

enum class SumData : std::uint8_t { Uniform, Signed, Wide, IllConditioned, Tiny };

struct SumDataName {
  SumData data;
  std::string_view name;
  std::string_view about;
};

inline constexpr std::array<SumDataName, 5> sumDataNames{{
    {SumData::Uniform, "uniform", "in [0, 1]"},
    {SumData::Signed, "signed", "in [-1, 1]"},
    {SumData::Wide, "wide", "of either sign, magnitudes from e^-10 to e^10"},
    {SumData::IllConditioned, "illconditioned", "that cancel but for 10^-12 of them"},
    {SumData::Tiny, "tiny", "of either sign, which, or whose products, are 2^-126 to 2^-90"},
}};

struct Pairs {
  std::vector<float> x, y;
};

/// Returns numbers x and factors y, whose products x * y are to be added; all factors are 1 unless
/// `hasFactors`.
Pairs drawPairs(SumData data, std::size_t count, bool hasFactors, unsigned seed);

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
