// SPDX-License-Identifier: MIT
//
// Four element-wise kernels that follow each other on one stream, in a loop, against a loop of one kernel that does the same. A run
// is one iteration, which takes one pass through memory at best; it goes on from the last one. floats: x.
#include "programs/loops.sk.hpp"

#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

class ChainTask : public OurTask {
 public:
  /// After one iteration from the start, since runs go on from each other.
  std::vector<float> result() final {
    x_.write(start_);
    once();
    return x_.read();
  }

 protected:
  ChainTask(sk::Device& device, const Problem& p)
      : OurTask(device), start_(p.floats[0]), x_(filled<float>({p.rows, p.columns}, start_)) {}

  const std::vector<float>& start_;  // the problem outlives the task
  sk::Stream<float> x_;
  sk::Loop loop_;

 private:
  void once() final { loop_.repeat(1); }
};

class Chain final : public ChainTask {
 public:
  Chain(sk::Device& device, const sk::CallOptions& options, const Problem& p) : ChainTask(device, p) {
    const auto lift = loops::lift.with(options);
    const auto bend = loops::bend.with(options);
    const auto shrink = loops::shrink.with(options);
    const auto turn = loops::turn.with(options);
    loop_ = device.record([&] {
      lift(x_, x_);
      bend(x_, x_);
      shrink(x_, x_);
      turn(x_, x_);
    });
  }
};

class ChainInOneKernel final : public ChainTask {
 public:
  ChainInOneKernel(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : ChainTask(device, p) {
    const auto together = loops::together.with(options);
    loop_ = device.record([&] { together(x_, x_); });
  }
};

class ChainInPipeline final : public ChainTask {
 public:
  ChainInPipeline(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : ChainTask(device, p) {
    const auto chained = loops::chained.with(options);
    loop_ = device.record([&] { chained(x_, x_); });
  }
};

}  // namespace

Check chainCheck(const Problem& p) {
  Check check{somePlaces(p.size()), {}, 0x1p-21};
  for (const std::int64_t place : check.places) {
    const double x = 0.5 * p.floats[0][static_cast<std::size_t>(place)] + 0.25;
    check.values.push_back(1 - 0.5 * (0.75 * (x - 0.25 * x * x) + 0.125));
  }
  return check;
}

std::unique_ptr<Task> chainOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Chain>(device, options, p);
}

std::unique_ptr<Task> chainInOneKernel(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<ChainInOneKernel>(device, options, p);
}

std::unique_ptr<Task> pipelineOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<ChainInPipeline>(device, options, p);
}

}  // namespace race
