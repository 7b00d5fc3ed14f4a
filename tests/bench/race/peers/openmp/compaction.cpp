// SPDX-License-Identifier: MIT
//
// Without branches, which random numbers make the processor guess wrong half of the time.
#include <vector>

#include <omp.h>

#include "peers/openmp/all.hpp"

namespace race {
namespace {

std::size_t keepPositive(const float* x, std::size_t count, float* kept) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    kept[next] = x[i];
    next += x[i] > 0 ? 1 : 0;
  }
  return next;
}

/// Results have room for one number that is overwritten.
class Compaction : public Task {
 public:
  explicit Compaction(const Problem& p) : x_(p.floats[0]), kept_(x_.size() + 1) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) once();
  }
  std::vector<float> result() override {
    return {kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(size_)};
  }

 protected:
  virtual void once() = 0;

  const std::vector<float>& x_;
  std::vector<float> kept_;
  std::size_t size_ = 0;
};

class SerialCompaction final : public Compaction {
 public:
  using Compaction::Compaction;

 private:
  void once() override { size_ = keepPositive(x_.data(), x_.size(), kept_.data()); }
};

// Each thread counts what it keeps of its part, and then knows where to put it.
class CompactionOpenMp final : public Compaction {
 public:
  using Compaction::Compaction;

 private:
  void once() override {
    std::vector<std::size_t> counts(static_cast<std::size_t>(omp_get_max_threads()) + 1);
#pragma omp parallel
    {
      const auto threads = static_cast<std::size_t>(omp_get_num_threads());
      const auto thread = static_cast<std::size_t>(omp_get_thread_num());
      const std::size_t begin = x_.size() * thread / threads, end = x_.size() * (thread + 1) / threads;
      std::size_t count = 0;
      for (std::size_t i = begin; i < end; ++i) count += x_[i] > 0 ? 1 : 0;
      counts[thread + 1] = count;
#pragma omp barrier
      std::size_t next = 0;
      for (std::size_t i = 0; i <= thread; ++i) next += counts[i];
      for (std::size_t i = begin; i < end; ++i) {
        if (x_[i] > 0) kept_[next++] = x_[i];
      }
      if (thread + 1 == threads) size_ = next;
    }
  }
};

}  // namespace

std::unique_ptr<Task> compactionSerial(const Problem& p) { return std::make_unique<SerialCompaction>(p); }
std::unique_ptr<Task> compactionOpenMp(const Problem& p) { return std::make_unique<CompactionOpenMp>(p); }

}  // namespace race
