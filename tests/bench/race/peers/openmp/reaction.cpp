// SPDX-License-Identifier: MIT
#include <utility>
#include <vector>

#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {
namespace {

/// u and v are fields of their own here, so that neighbours are neighbours in memory, too.
class ReactionOpenMp final : public Task {
 public:
  explicit ReactionOpenMp(const Problem& p) : rows_(p.rows), columns_(p.columns) {
    const auto n = static_cast<std::size_t>(p.size());
    for (auto* field : {&startU_, &startV_, &u_, &v_, &nextU_, &nextV_}) field->resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      startU_[i] = p.floats[0][2 * i];
      startV_[i] = p.floats[0][2 * i + 1];
    }
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) {
      advance(startU_.data(), startV_.data());
      for (int step = 1; step < reactionSteps; ++step) advance(u_.data(), v_.data());
    }
  }
  std::vector<float> result() override {
    std::vector<float> parts;
    for (std::size_t i = 0; i < u_.size(); ++i) parts.insert(parts.end(), {u_[i], v_[i]});
    return parts;
  }

 private:
  void advance(const float* u, const float* v) {
#pragma omp parallel for
    for (std::int64_t y = 0; y < rows_; ++y) {
      const std::int64_t row = y * columns_;
      const std::int64_t above = (y == 0 ? rows_ - 1 : y - 1) * columns_,
                         below = (y + 1 == rows_ ? 0 : y + 1) * columns_;
      const auto react = [&](std::int64_t left, std::int64_t x, std::int64_t right) {
        const float a = u[row + x], b = v[row + x], reaction = a * b * b;
        const float lapU = u[row + left] + u[row + right] + u[above + x] + u[below + x] - 4 * a;
        const float lapV = v[row + left] + v[row + right] + v[above + x] + v[below + x] - 4 * b;
        nextU_[static_cast<std::size_t>(row + x)] =
            a + (reactionSpreadU * lapU - reaction + reactionFeed * (1 - a));
        nextV_[static_cast<std::size_t>(row + x)] =
            b + (reactionSpreadV * lapV + reaction - (reactionFeed + reactionKill) * b);
      };
      react(columns_ - 1, 0, 1);
#pragma omp simd
      for (std::int64_t x = 1; x < columns_ - 1; ++x) react(x - 1, x, x + 1);
      react(columns_ - 2, columns_ - 1, 0);
    }
    std::swap(u_, nextU_);
    std::swap(v_, nextV_);
  }

  std::int64_t rows_, columns_;
  std::vector<float> startU_, startV_, u_, v_, nextU_, nextV_;
};

}  // namespace

std::unique_ptr<Task> reactionOpenMp(const Problem& p) { return std::make_unique<ReactionOpenMp>(p); }

}  // namespace race
