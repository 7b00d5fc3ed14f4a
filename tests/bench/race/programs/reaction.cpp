// SPDX-License-Identifier: MIT
//
// Ten steps of Gray and Scott's reaction on a torus. floats: u and v of each element in turn, as in the result.
#include <utility>

#include "constants.hpp"
#include "reaction.sk.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

class Reaction final : public OurTask {
 public:
  Reaction(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        advance_(reaction::advance.with(options)),
        start_(filled<sk::float2>({p.rows, p.columns}, pairsOf(p.floats[0]))),
        field_(device.stream<sk::float2>({p.rows, p.columns})) {}

  std::vector<float> result() override { return flat(field_.read()); }

 private:
  void once() override {
    const reaction::Medium medium{reactionFeed, reactionKill, reactionSpreadU, reactionSpreadV, 1};
    advance_(medium, start_, field_);
    for (int step = 1; step < reactionSteps; ++step) advance_(medium, field_, field_);
  }

  reaction::AdvanceKernel advance_;
  sk::Stream<sk::float2> start_, field_;
};

/// One step in double precision.
std::vector<double> advanced(const std::vector<double>& c, std::int64_t rows, std::int64_t columns) {
  std::vector<double> next(c.size());
  for (std::int64_t y = 0; y < rows; ++y) {
    for (std::int64_t x = 0; x < columns; ++x) {
      const auto at = [&](std::int64_t dy, std::int64_t dx, int part) {
        const std::int64_t row = (y + dy + rows) % rows, column = (x + dx + columns) % columns;
        return c[static_cast<std::size_t>(2 * (row * columns + column) + part)];
      };
      const auto around = [&](int part) {
        return at(0, -1, part) + at(0, 1, part) + at(-1, 0, part) + at(1, 0, part) - 4 * at(0, 0, part);
      };
      const double u = at(0, 0, 0), v = at(0, 0, 1);
      const auto here = static_cast<std::size_t>(2 * (y * columns + x));
      next[here] = u + reactionSpreadU * around(0) - u * v * v + reactionFeed * (1 - u);
      next[here + 1] =
          v + reactionSpreadV * around(1) + u * v * v - (double{reactionFeed} + reactionKill) * v;
    }
  }
  return next;
}

}  // namespace

Problem reactionProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(2 * p.size(), 1)};
  return p;
}

Check reactionCheck(const Problem& p) {
  std::vector<double> field(p.floats[0].begin(), p.floats[0].end());
  for (int step = 0; step < reactionSteps; ++step) field = advanced(field, p.rows, p.columns);
  return {{}, std::move(field), 1e-5};
}

std::unique_ptr<Task> reactionOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Reaction>(device, options, p);
}

}  // namespace race
