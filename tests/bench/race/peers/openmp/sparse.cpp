// SPDX-License-Identifier: MIT
#include "peers/openmp/all.hpp"

namespace race {

void sparseOpenMp(const Problem& p, float* y) {
  const std::int32_t* starts = p.ints[0].data();
  const std::int32_t* columns = p.ints[1].data();
  const float* values = p.floats[0].data();
  const float* x = p.floats[1].data();
  const std::int64_t rows = p.size();
#pragma omp parallel for
  for (std::int64_t row = 0; row < rows; ++row) {
    float sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::int32_t i = starts[row]; i < starts[row + 1]; ++i) sum += values[i] * x[columns[i]];
    y[row] = sum;
  }
}

}  // namespace race
