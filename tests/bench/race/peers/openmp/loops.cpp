// SPDX-License-Identifier: MIT
//
// Programs that repeat a step: each step is a loop over the whole grid, and pointers are swapped between them.
#include <utility>
#include <vector>

#include "constants.hpp"
#include "peers/openmp/all.hpp"
#include "peers/openmp/stencil.hpp"

namespace race {
namespace {

using Reals = std::vector<float>;

Reals asLongAs(const Reals& other) { return Reals(other.size()); }

class HeatLoop final : public Task {
 public:
  explicit HeatLoop(const Problem& p) : p_(p), u_(asLongAs(p.floats[0])), v_(u_) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) {
      heatStep(p_.rows, p_.columns, heatFlow, p_.floats[0].data(), u_.data());
      for (int step = 1; step < loopSteps; ++step) {
        heatStep(p_.rows, p_.columns, heatFlow, u_.data(), v_.data());
        std::swap(u_, v_);
      }
    }
  }
  Reals result() override { return u_; }

 private:
  const Problem& p_;
  Reals u_, v_;
};

class WaveLoop final : public Task {
 public:
  explicit WaveLoop(const Problem& p)
      : p_(p), u_(asLongAs(p.floats[0])), before_(u_), still_(static_cast<std::size_t>(p.columns)) {}

  void run(int times) override {
    const float* start = p_.floats[0].data();
    for (int i = 0; i < times; ++i) {
      advance(start, start, before_.data());
      advance(before_.data(), start, u_.data());
      for (int step = 2; step < loopSteps; ++step) {
        advance(u_.data(), before_.data(), before_.data());
        std::swap(u_, before_);
      }
    }
  }
  Reals result() override { return u_; }

 private:
  void advance(const float* u, const float* before, float* after) const {
    const std::int64_t rows = p_.rows, columns = p_.columns;
#pragma omp parallel for
    for (std::int64_t y = 0; y < rows; ++y) {
      const float* row = u + y * columns;
      const float* above = y == 0 ? still_.data() : row - columns;
      const float* below = y + 1 == rows ? still_.data() : row + columns;
      const float* b = before + y * columns;
      float* a = after + y * columns;
      const auto moved = [&](float west, std::int64_t x, float east) {
        return 2 * row[x] - b[x] + waveStiffness * (west + east + above[x] + below[x] - 4 * row[x]);
      };
      a[0] = moved(0, 0, row[1]);
#pragma omp simd
      for (std::int64_t x = 1; x < columns - 1; ++x) a[x] = moved(row[x - 1], x, row[x + 1]);
      a[columns - 1] = moved(row[columns - 2], columns - 1, 0);
    }
  }

  const Problem& p_;
  Reals u_, before_, still_;
};

/// Goes on from the last run, as ours do.
class ChainOpenMp final : public Task {
 public:
  explicit ChainOpenMp(const Problem& p) : p_(p), x_(p.floats[0]) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) once();
  }
  Reals result() override {
    x_ = p_.floats[0];
    once();
    return x_;
  }

 private:
  void once() {
    float* x = x_.data();
    const auto n = static_cast<std::int64_t>(x_.size());
#pragma omp parallel for simd
    for (std::int64_t i = 0; i < n; ++i) {
      const float lifted = 0.5f * x[i] + 0.25f;
      const float bent = lifted - 0.25f * lifted * lifted;
      x[i] = 1 - 0.5f * (0.75f * bent + 0.125f);
    }
  }

  const Problem& p_;
  Reals x_;
};

}  // namespace

std::unique_ptr<Task> heatLoopOpenMp(const Problem& p) { return std::make_unique<HeatLoop>(p); }
std::unique_ptr<Task> waveLoopOpenMp(const Problem& p) { return std::make_unique<WaveLoop>(p); }
std::unique_ptr<Task> chainOpenMp(const Problem& p) { return std::make_unique<ChainOpenMp>(p); }

}  // namespace race
