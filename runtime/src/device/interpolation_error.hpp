// SPDX-License-Identifier: MIT
//
// A bound for the error of a table (sk/table.hpp) over all floats of its range, from samples of the function. Where the error
// of the polynomials bends between two samples, more are taken, down to neighbouring floats if need be; a function that
// still bends is reported as unresolved. Knows neither kernels nor devices.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sk/table.hpp"

namespace sk {

/// A function's values, computed in double. Throws if one is not finite.
using FunctionValues = std::function<std::vector<double>(const std::vector<double>& arguments)>;

struct InterpolationError {
  double bound = 0;  ///< of the absolute error of a lookup in float arithmetic
  /// Neighbouring samples between which too many samples would be needed: the bound does not hold.
  std::optional<std::pair<double, double>> unresolved = {};
};

/// The polynomials are those of native::Table. `seen` is an error that occurs.
///
/// Between two samples, the error is at most the larger of the two, and 4 times of what the chord of two samples on either side
/// misses when it is continued across: 8 times of what a kink adds, at least 16 times of what a curve does, and 2.7 times of what the
/// cusp of a square root does. Samples are irregular, so that no period hides between them.
InterpolationError interpolationError(const FunctionValues& values, const TableRange& range,
                                      Interpolation interpolation, std::span<const float> coefficients,
                                      double seen);

}  // namespace sk
