// SPDX-License-Identifier: MIT
//
// A table that replaces a function of one float (sk/table.hpp), and its lookup, with the same arithmetic as
// the GLSL that the assembler writes (assemble/glsl/tables.hpp).
#pragma once

#include <algorithm>
#include <cstddef>

namespace sk::native {

/// The polynomials of the intervals, lowest coefficient first: two coefficients each, or four if cubic.
struct Table {
  const float* coefficients = nullptr;
  float low = 0;
  float perUnit = 0;  ///< intervals per unit of the argument
  int intervals = 0;
  bool isCubic = false;

  /// Clamps arguments to the range; NaN gives NaN.
  float at(float x) const {
    if (x != x) return x;
    const float place = std::clamp((x - low) * perUnit, 0.0F, static_cast<float>(intervals));
    const int interval = std::min(static_cast<int>(place), intervals - 1);
    const float t = place - static_cast<float>(interval);
    const float* const c = coefficients + static_cast<std::ptrdiff_t>(interval) * (isCubic ? 4 : 2);
    return isCubic ? c[0] + t * (c[1] + t * (c[2] + t * c[3])) : c[0] + t * c[1];
  }
};

}  // namespace sk::native
