// SPDX-License-Identifier: MIT
//
// How the result of a contender is judged before it takes part.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace race {

/// What some or all numbers of the result must be.
struct Check {
  std::vector<std::int64_t> places;  ///< none: all, in order
  std::vector<double> values;
  double tolerance = 0;  ///< relative to the largest magnitude of `values`
  double exempt =
      0;  ///< the part of them that may be further off, where a rounding decides (Mandelbrot's border)
};

/// What is wrong with a result; nothing where it is right.
std::optional<std::string> faultOf(const std::vector<float>& result, const Check& check);

}  // namespace race
