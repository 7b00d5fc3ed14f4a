// SPDX-License-Identifier: MIT
//
// A hundred steps of the heat equation, of Gray and Scott's reaction and of the wave equation, from the same start in each run:
// in a loop that the device repeats, and call by call. floats: a field each. The first steps read the start, so that nothing is
// copied, and are calls in both ways.
#include "programs/loops.sk.hpp"

#include <utility>

#include "constants.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"
#include "programs/evolution.hpp"

namespace race {
namespace {

enum class Way { Loop, Calls };

class Steps : public OurTask {
 protected:
  Steps(sk::Device& device, Way way) : OurTask(device), way_(way) {}

  sk::Stream<float> field(const Problem& p) { return device().stream<float>({p.rows, p.columns}); }
  sk::Stream<float> field(const Problem& p, std::size_t number) {
    return filled<float>({p.rows, p.columns}, p.floats[number]);
  }

 private:
  /// Computes the first steps from the start, and returns how many these are.
  virtual int begin() = 0;
  /// Computes the next step. This is recorded.
  virtual void step() = 0;

  void once() final {
    int steps = begin();
    if (way_ == Way::Calls) {
      for (; steps < loopSteps; ++steps) step();
      return;
    }
    if (!loop_) loop_ = device().record([&] { step(); });
    loop_.repeat(loopSteps - steps);
  }

  Way way_;
  sk::Loop loop_;
};

class HeatSteps final : public Steps {
 public:
  HeatSteps(sk::Device& device, const sk::CallOptions& options, const Problem& p, Way way)
      : Steps(device, way),
        heat_(loops::heat.with(options)),
        start_(field(p, 0)),
        u_(field(p)),
        v_(field(p)) {}

  std::vector<float> result() override { return u_.read(); }

 private:
  int begin() override {
    heat_(heatFlow, start_, u_);
    return 1;
  }
  void step() override {
    heat_(heatFlow, u_, v_);
    std::swap(u_, v_);
  }

  loops::HeatKernel heat_;
  sk::Stream<float> start_, u_, v_;
};

class ReactionSteps final : public Steps {
 public:
  ReactionSteps(sk::Device& device, const sk::CallOptions& options, const Problem& p, Way way)
      : Steps(device, way),
        react_(loops::react.with(options)),
        startU_(field(p, 0)),
        startV_(field(p, 1)),
        u_(field(p)),
        v_(field(p)),
        nextU_(field(p)),
        nextV_(field(p)) {}

  std::vector<float> result() override {
    std::vector<float> all = u_.read();
    const std::vector<float> other = v_.read();
    all.insert(all.end(), other.begin(), other.end());
    return all;
  }

 private:
  void react(const sk::Stream<float>& u, const sk::Stream<float>& v, sk::Stream<float>& nextU,
             sk::Stream<float>& nextV) {
    react_(reactionFeed, reactionKill, reactionSpreadU, reactionSpreadV, u, v, nextU, nextV);
  }
  int begin() override {
    react(startU_, startV_, u_, v_);
    return 1;
  }
  void step() override {
    react(u_, v_, nextU_, nextV_);
    std::swap(u_, nextU_);
    std::swap(v_, nextV_);
  }

  loops::ReactKernel react_;
  sk::Stream<float> startU_, startV_, u_, v_, nextU_, nextV_;
};

/// From rest. A step writes over what was before.
class WaveSteps final : public Steps {
 public:
  WaveSteps(sk::Device& device, const sk::CallOptions& options, const Problem& p, Way way)
      : Steps(device, way),
        wave_(loops::wave.with(options)),
        start_(field(p, 0)),
        u_(field(p)),
        before_(field(p)) {}

  std::vector<float> result() override { return u_.read(); }

 private:
  int begin() override {
    wave_(waveStiffness, start_, start_, before_);
    wave_(waveStiffness, before_, start_, u_);
    return 2;
  }
  void step() override {
    wave_(waveStiffness, u_, before_, before_);
    std::swap(u_, before_);
  }

  loops::WaveKernel wave_;
  sk::Stream<float> start_, u_, before_;
};

/// The sum of a field beside a cell, less four times the cell.
double laplacian(const std::vector<double>& f, const Cell& c) {
  return f[c.west] + f[c.east] + f[c.north] + f[c.south] - 4 * f[c.here];
}

}  // namespace

// A step averages the errors of earlier ones, so that these stay at a few roundings: 2^-22 of the largest value.
Check heatLoopCheck(const Problem& p) {
  const auto step = [](const Lattice& now, Lattice& next) {
    const std::vector<double>& u = now.fields[0];
    std::vector<double>& v = next.fields[0];
    forEachCell(now, Edge::Clamp, [&](const Cell& c) { v[c.here] = u[c.here] + heatFlow * laplacian(u, c); });
  };
  return evolutionCheck(p, {Edge::Clamp, loopSteps, step}, 0x1p-20);
}

std::unique_ptr<Task> heatLoopOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<HeatSteps>(device, options, p, Way::Loop);
}
std::unique_ptr<Task> heatLoopCalls(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<HeatSteps>(device, options, p, Way::Calls);
}

// With more steps, v would vanish in most places, and processors are slow with numbers that are almost 0.
Problem reactionLoopProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1), numbers(p.size(), 2)};
  return p;
}

// Errors are as small as those of the heat equation.
Check reactionLoopCheck(const Problem& p) {
  const auto step = [](const Lattice& now, Lattice& next) {
    const std::vector<double>&u = now.fields[0], &v = now.fields[1];
    std::vector<double>&nextU = next.fields[0], &nextV = next.fields[1];
    forEachCell(now, Edge::Wrap, [&](const Cell& c) {
      const double a = u[c.here], b = v[c.here];
      nextU[c.here] = a + reactionSpreadU * laplacian(u, c) - a * b * b + reactionFeed * (1 - a);
      nextV[c.here] =
          b + reactionSpreadV * laplacian(v, c) + a * b * b - (double{reactionFeed} + reactionKill) * b;
    });
  };
  return evolutionCheck(p, {Edge::Wrap, loopSteps, step}, 0x1p-20);
}

std::unique_ptr<Task> reactionLoopOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<ReactionSteps>(device, options, p, Way::Loop);
}
std::unique_ptr<Task> reactionLoopCalls(sk::Device& device, const sk::CallOptions& options,
                                        const Problem& p) {
  return std::make_unique<ReactionSteps>(device, options, p, Way::Calls);
}

// A step adds to differences of positions, so that errors grow faster than the number of steps: 2^-18.5 of the largest value.
Check waveLoopCheck(const Problem& p) {
  const auto step = [](const Lattice& now, Lattice& next) {
    const std::vector<double>& u = now.fields[0];
    std::vector<double>& after = next.fields[0];
    forEachCell(now, Edge::Zero, [&](const Cell& c) {
      after[c.here] = 2 * u[c.here] - after[c.here] + waveStiffness * laplacian(u, c);
    });
  };
  return evolutionCheck(p, {Edge::Zero, loopSteps, step}, 0x1p-16);
}

std::unique_ptr<Task> waveLoopOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<WaveSteps>(device, options, p, Way::Loop);
}
std::unique_ptr<Task> waveLoopCalls(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<WaveSteps>(device, options, p, Way::Calls);
}

}  // namespace race
