// SPDX-License-Identifier: MIT
//
// Floats that use all their bits, so that every sum and product is rounded, and the comparison of results with values in
// double, each with its error bound.
#pragma once

#include <cmath>
#include <concepts>
#include <sstream>
#include <string>
#include <vector>

#include "support/values.hpp"

namespace run_tests {

/// The largest relative error of rounding to the nearest float.
inline constexpr double unitRoundoff = 0x1p-24;

/// The largest relative error after n roundings: N. J. Higham, "Accuracy and stability of numerical algorithms",
/// second edition (2002), section 3.1.
inline double roundings(double n) { return n * unitRoundoff / (1 - n * unitRoundoff); }

/// Element i of a sequence in [-1, 1) with 24 significant bits.
inline float noise(std::size_t i, std::uint32_t seed = 0) {
  const std::uint32_t bits = hashed(static_cast<std::uint32_t>(i) * 2654435761u + seed * 7919u + 99u);
  return static_cast<float>(static_cast<std::int32_t>(bits)) * 0x1p-31f;
}

inline std::vector<float> noises(std::int64_t count, std::uint32_t seed = 0) {
  std::vector<float> result(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = noise(i, seed);
  return result;
}

struct Bounded {
  double value, error;
};

/// "" if every element is within the error bound of its expected value, else the first that is not.
template <std::invocable<std::size_t> Expected>
std::string outside(const std::vector<float>& actual, const Expected& expected) {
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const Bounded wanted = expected(i);
    if (std::fabs(actual[i] - wanted.value) <= wanted.error) continue;
    std::ostringstream out;
    out.precision(9);
    out << '[' << i << "] is " << actual[i] << ", not " << wanted.value << " within " << wanted.error;
    return out.str();
  }
  return "";
}

}  // namespace run_tests
