// SPDX-License-Identifier: MIT
//
// Coefficients that jump from element to element of a grid, by the name of their pattern.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "stencil.hpp"

namespace linear {

struct CoefficientPattern {
  std::string_view name;  ///< in "poisson:WxH:NAME=RATIO"
  std::string_view does;
  /// Returns a coefficient for each element: 1 in the background, and up to `ratio` elsewhere.
  std::vector<double> (*make)(const Stencil& grid, double ratio);
};

std::span<const CoefficientPattern> coefficientPatterns();

}  // namespace linear
