// SPDX-License-Identifier: MIT
#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {
namespace {

constexpr int lanes = 32;  // pixels that go together until all have escaped

/// The steps of `lanes` neighbours of a row.
void escape(const float* cx, float cy, float* result) {
  float x[lanes] = {}, y[lanes] = {};
  int steps[lanes] = {};
  for (int round = 0; round < mandelbrotSteps; ++round) {
    int inside = 0;
#pragma omp simd reduction(+ : inside)
    for (int lane = 0; lane < lanes; ++lane) {
      const int isInside = x[lane] * x[lane] + y[lane] * y[lane] <= 4;
      // Who has escaped goes on, to infinity or NaN, and is not counted again.
      const float next = x[lane] * x[lane] - y[lane] * y[lane] + cx[lane];
      y[lane] = 2 * x[lane] * y[lane] + cy;
      x[lane] = next;
      steps[lane] += isInside;
      inside += isInside;
    }
    if (inside == 0) break;
  }
  for (int lane = 0; lane < lanes; ++lane) result[lane] = static_cast<float>(steps[lane]);
}

}  // namespace

// Pictures are powers of two wide, and at least `lanes`.
void mandelbrotOpenMp(const Problem& p, float* result) {
  const float perColumn = mandelbrotExtent / static_cast<float>(p.columns);
  const float perRow = mandelbrotExtent / static_cast<float>(p.rows);
#pragma omp parallel for schedule(dynamic)
  for (std::int64_t row = 0; row < p.rows; ++row) {
    const float cy = mandelbrotTop + perRow * (static_cast<float>(row) + 0.5f);
    for (std::int64_t first = 0; first < p.columns; first += lanes) {
      float cx[lanes];
      for (int lane = 0; lane < lanes; ++lane) {
        cx[lane] = mandelbrotLeft + perColumn * (static_cast<float>(first + lane) + 0.5f);
      }
      escape(cx, cy, result + row * p.columns + first);
    }
  }
}

}  // namespace race
