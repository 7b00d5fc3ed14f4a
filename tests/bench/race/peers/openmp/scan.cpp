// SPDX-License-Identifier: MIT
#include <vector>

#include <omp.h>

#include "peers/openmp/all.hpp"

namespace race {

// Each thread sums its part, then begins with the sum of the parts before it.
class ScanOpenMp final : public Task {
 public:
  explicit ScanOpenMp(const Problem& p) : x_(p.ints[0]), before_(x_.size()) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) once();
  }
  std::vector<float> result() override { return {before_.begin(), before_.end()}; }

 private:
  void once() {
    std::vector<std::int32_t> parts(static_cast<std::size_t>(omp_get_max_threads()) + 1);
#pragma omp parallel
    {
      const auto threads = static_cast<std::size_t>(omp_get_num_threads());
      const auto thread = static_cast<std::size_t>(omp_get_thread_num());
      const std::size_t begin = x_.size() * thread / threads, end = x_.size() * (thread + 1) / threads;
      std::int32_t sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += x_[i];
      parts[thread + 1] = sum;
#pragma omp barrier
      std::int32_t before = 0;
      for (std::size_t i = 0; i <= thread; ++i) before += parts[i];
      for (std::size_t i = begin; i < end; ++i) {
        before_[i] = before;
        before += x_[i];
      }
    }
  }

  const std::vector<std::int32_t>& x_;
  std::vector<std::int32_t> before_;
};

std::unique_ptr<Task> scanOpenMp(const Problem& p) { return std::make_unique<ScanOpenMp>(p); }

}  // namespace race
