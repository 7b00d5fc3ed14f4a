// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include "peers/openmp/all.hpp"

namespace race {

void gemvOpenMp(const Problem& p, float* y) {
  const float* a = p.floats[0].data();
  const float* x = p.floats[1].data();
#pragma omp parallel for
  for (std::int64_t row = 0; row < p.rows; ++row) {
    const float* r = a + row * p.columns;
    float dot = 0;
#pragma omp simd reduction(+ : dot)
    for (std::int64_t i = 0; i < p.columns; ++i) dot += r[i] * x[i];
    y[row] = dot;
  }
}

// Tiles of C stay in registers while rows of B pass, of which a panel is kept in order, as the cache likes it. Sizes are
// powers of two, no side below 32.
void gemmOpenMp(const Problem& p, float* c) {
  constexpr int down = 4, across = 16;
  const float* a = p.floats[0].data();
  const float* b = p.floats[1].data();
  const std::int64_t columns = p.columns;
#pragma omp parallel
  {
    std::vector<float> panel(static_cast<std::size_t>(columns * across));
#pragma omp for
    for (std::int64_t x = 0; x < columns; x += across) {
      for (std::int64_t k = 0; k < columns; ++k)
        std::copy_n(b + k * columns + x, across, panel.data() + k * across);
      for (std::int64_t y = 0; y < p.rows; y += down) {
        float tile[down][across] = {};
        for (std::int64_t k = 0; k < columns; ++k) {
          const float* row = panel.data() + k * across;
          for (int i = 0; i < down; ++i) {
            const float factor = a[(y + i) * columns + k];
#pragma omp simd
            for (int j = 0; j < across; ++j) tile[i][j] += factor * row[j];
          }
        }
        for (int i = 0; i < down; ++i) std::copy_n(tile[i], across, c + (y + i) * columns + x);
      }
    }
  }
}

}  // namespace race
