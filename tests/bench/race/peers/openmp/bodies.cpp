// SPDX-License-Identifier: MIT
#include <cmath>

#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {

void bodiesOpenMp(const Problem& p, float* result) {
  const float* x = p.floats[0].data();
  const float* y = p.floats[1].data();
  const float* z = p.floats[2].data();
  const float* mass = p.floats[3].data();
  const std::int64_t n = p.size();
#pragma omp parallel for
  for (std::int64_t i = 0; i < n; ++i) {
    float ax = 0, ay = 0, az = 0;
#pragma omp simd reduction(+ : ax, ay, az)
    for (std::int64_t j = 0; j < n; ++j) {
      const float dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
      const float nearness = 1 / std::sqrt(dx * dx + dy * dy + dz * dz + softening);
      const float pull = mass[j] * nearness * nearness * nearness;
      ax += pull * dx;
      ay += pull * dy;
      az += pull * dz;
    }
    result[3 * i] = ax;
    result[3 * i + 1] = ay;
    result[3 * i + 2] = az;
  }
}

}  // namespace race
