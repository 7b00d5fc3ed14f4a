// SPDX-License-Identifier: MIT
//
// Stencils as loops over rows.
#pragma once

#include <algorithm>
#include <cstdint>

namespace race {

/// value(above, row, below, left, x, right) for each element of a grid whose border elements continue outside, where left and
/// right are columns. All but the borders is one loop without a condition, which vectorises.
template <class Value>
void stencil(std::int64_t rows, std::int64_t columns, const float* u, float* result, const Value& value) {
#pragma omp parallel for
  for (std::int64_t y = 0; y < rows; ++y) {
    const float* row = u + y * columns;
    const float* above = u + std::max<std::int64_t>(y - 1, 0) * columns;
    const float* below = u + std::min(y + 1, rows - 1) * columns;
    float* r = result + y * columns;
    const auto at = [&](std::int64_t left, std::int64_t x, std::int64_t right) {
      return value(above, row, below, left, x, right);
    };
    r[0] = at(0, 0, std::min<std::int64_t>(1, columns - 1));
#pragma omp simd
    for (std::int64_t x = 1; x < columns - 1; ++x) r[x] = at(x - 1, x, x + 1);
    r[columns - 1] = at(std::max<std::int64_t>(columns - 2, 0), columns - 1, columns - 1);
  }
}

/// A step of the heat equation on such a grid.
inline void heatStep(std::int64_t rows, std::int64_t columns, float flow, const float* u, float* v) {
  stencil(rows, columns, u, v,
          [=](const float* above, const float* row, const float* below, auto left, auto x, auto right) {
            return row[x] + flow * (row[left] + row[right] + above[x] + below[x] - 4 * row[x]);
          });
}

}  // namespace race
