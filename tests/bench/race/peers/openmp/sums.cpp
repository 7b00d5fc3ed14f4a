// SPDX-License-Identifier: MIT
#include <algorithm>

#include "peers/openmp/all.hpp"

namespace race {
namespace {

constexpr int lanes = 64;  // of several vectors, so that additions need not wait for each other

/// Sums in lanes with what each addition loses (D. E. Knuth's TwoSum) summed beside them.
struct Compensated {
  float sums[lanes] = {};
  float errors[lanes] = {};

  void add(const float* x) {
#pragma omp simd
    for (int lane = 0; lane < lanes; ++lane) {
      const float sum = sums[lane] + x[lane];
      const float part = sum - sums[lane];
      errors[lane] += (sums[lane] - (sum - part)) + (x[lane] - part);
      sums[lane] = sum;
    }
  }
  double total() const {
    double total = 0;
    for (int lane = 0; lane < lanes; ++lane) total += double{sums[lane]} + errors[lane];
    return total;
  }
};

}  // namespace

void sumOpenMp(const Problem& p, float* total) {
  const float* x = p.floats[0].data();
  const std::int64_t blocks = p.size() / lanes;
  double all = 0;
#pragma omp parallel reduction(+ : all)
  {
    float sums[lanes] = {};
#pragma omp for nowait
    for (std::int64_t block = 0; block < blocks; ++block) {
#pragma omp simd
      for (int lane = 0; lane < lanes; ++lane) sums[lane] += x[block * lanes + lane];
    }
    for (const float sum : sums) all += sum;
  }
  for (std::int64_t i = blocks * lanes; i < p.size(); ++i) all += x[i];
  *total = static_cast<float>(all);
}

void compensatedSumOpenMp(const Problem& p, float* total) {
  const float* x = p.floats[0].data();
  const std::int64_t blocks = p.size() / lanes;
  double all = 0;
#pragma omp parallel reduction(+ : all)
  {
    Compensated sums;
#pragma omp for nowait
    for (std::int64_t block = 0; block < blocks; ++block) sums.add(x + block * lanes);
    all += sums.total();
  }
  for (std::int64_t i = blocks * lanes; i < p.size(); ++i) all += x[i];
  *total = static_cast<float>(all);
}

void dotOpenMp(const Problem& p, float* total) {
  const float* x = p.floats[0].data();
  const float* y = p.floats[1].data();
  const std::int64_t blocks = p.size() / lanes;
  double all = 0;
#pragma omp parallel reduction(+ : all)
  {
    float sums[lanes] = {};
#pragma omp for nowait
    for (std::int64_t block = 0; block < blocks; ++block) {
#pragma omp simd
      for (int lane = 0; lane < lanes; ++lane)
        sums[lane] += x[block * lanes + lane] * y[block * lanes + lane];
    }
    for (const float sum : sums) all += sum;
  }
  for (std::int64_t i = blocks * lanes; i < p.size(); ++i) all += x[i] * y[i];
  *total = static_cast<float>(all);
}

}  // namespace race
