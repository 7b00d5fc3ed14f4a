// SPDX-License-Identifier: MIT
#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {

void residualOpenMp(const Problem& p, float* result) {
  constexpr int lanes = 64;  // of several vectors, so that additions need not wait for each other
  const float* q = p.floats[0].data();
  const float* r = p.floats[1].data();
  const std::int64_t blocks = p.size() / lanes;
  double all = 0;
#pragma omp parallel reduction(+ : all)
  {
    float sums[lanes] = {};
#pragma omp for nowait
    for (std::int64_t block = 0; block < blocks; ++block) {
#pragma omp simd
      for (int lane = 0; lane < lanes; ++lane) {
        const std::int64_t i = block * lanes + lane;
        const float next = r[i] - residualStep * q[i];
        result[i] = next;
        sums[lane] += next * next;
      }
    }
    for (const float sum : sums) all += sum;
  }
  for (std::int64_t i = blocks * lanes; i < p.size(); ++i) {
    const float next = r[i] - residualStep * q[i];
    result[i] = next;
    all += next * next;
  }
  result[p.size()] = static_cast<float>(all / static_cast<double>(p.size()));
}

}  // namespace race
