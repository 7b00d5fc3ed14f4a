// SPDX-License-Identifier: MIT
#include "info/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

namespace sk_tool {

double ulpOf(double number) {
  int exponent = 0;
  std::frexp(number, &exponent);
  return std::ldexp(1.0, (number == 0 ? -126 : std::max(exponent - 1, -126)) - 23);
}

double rounded(double value) { return std::strtod(fmt::format("{:.3g}", value).c_str(), nullptr); }

void ErrorStatistics::add(float got, double reference, double argument) {
  if (!std::isfinite(got)) {
    ++notFinite_;
    return;
  }
  const double absolute = double{got} - reference;
  const double error = absolute / ulpOf(reference);
  if (std::fabs(error) > max_) {
    max_ = std::fabs(error);
    worstAt_ = argument;
  }
  least_ = std::min(least_, error);
  most_ = std::max(most_, error);
  maxAbsolute_ = std::max(maxAbsolute_, std::fabs(absolute));
  sum_ += std::fabs(error);
  ++count_;
}

Json ErrorStatistics::json() const {
  return {{"max", rounded(max_)},
          {"mean", rounded(count_ == 0 ? 0 : sum_ / static_cast<double>(count_))},
          {"min_signed", rounded(least_)},
          {"max_signed", rounded(most_)},
          {"max_absolute", rounded(maxAbsolute_)},
          {"worst_at", worstAt_},
          {"not_finite", notFinite_}};
}

}  // namespace sk_tool
