// SPDX-License-Identifier: MIT
#include <utility>
#include <vector>

#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {
namespace {

using Field = std::vector<float>;

/// u and v are fields of their own here, so that neighbours are neighbours in memory, too.
class ReactionOpenMp : public Task {
 public:
  void run(int times) final {
    for (int i = 0; i < times; ++i) {
      advance(startU_.data(), startV_.data());
      for (int step = 1; step < steps_; ++step) advance(u_.data(), v_.data());
    }
  }

 protected:
  ReactionOpenMp(const Problem& p, Field startU, Field startV, int steps)
      : rows_(p.rows),
        columns_(p.columns),
        steps_(steps),
        startU_(std::move(startU)),
        startV_(std::move(startV)),
        u_(startU_.size()),
        v_(u_),
        nextU_(u_),
        nextV_(u_) {}

  const Field& u() const { return u_; }
  const Field& v() const { return v_; }

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
  int steps_;
  Field startU_, startV_, u_, v_, nextU_, nextV_;
};

/// Every second number, from `first` on.
Field everySecond(const Field& numbers, std::size_t first) {
  Field some;
  for (std::size_t i = first; i < numbers.size(); i += 2) some.push_back(numbers[i]);
  return some;
}

/// u and v of each element in turn.
class InTurn final : public ReactionOpenMp {
 public:
  explicit InTurn(const Problem& p)
      : ReactionOpenMp(p, everySecond(p.floats[0], 0), everySecond(p.floats[0], 1), reactionSteps) {}

  std::vector<float> result() override {
    std::vector<float> parts;
    for (std::size_t i = 0; i < u().size(); ++i) parts.insert(parts.end(), {u()[i], v()[i]});
    return parts;
  }
};

/// All of u, and then all of v.
class OneByOne final : public ReactionOpenMp {
 public:
  explicit OneByOne(const Problem& p) : ReactionOpenMp(p, p.floats[0], p.floats[1], loopSteps) {}

  std::vector<float> result() override {
    std::vector<float> all = u();
    all.insert(all.end(), v().begin(), v().end());
    return all;
  }
};

}  // namespace

std::unique_ptr<Task> reactionOpenMp(const Problem& p) { return std::make_unique<InTurn>(p); }
std::unique_ptr<Task> reactionLoopOpenMp(const Problem& p) { return std::make_unique<OneByOne>(p); }

}  // namespace race
