// SPDX-License-Identifier: MIT
#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {

void saxpyOpenMp(const Problem& p, float* r) {
  const float* x = p.floats[0].data();
  const float* y = p.floats[1].data();
  const std::int64_t n = p.size();
#pragma omp parallel for simd
  for (std::int64_t i = 0; i < n; ++i) r[i] = saxpyFactor * x[i] + y[i];
}

}  // namespace race
