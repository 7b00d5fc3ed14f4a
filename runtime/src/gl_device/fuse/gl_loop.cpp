// SPDX-License-Identifier: MIT
//
// Loops on a GL device: iterations run call by call or in fused passes, and are repeated from notes (pass/replay.hpp). Where tiles may
// run several iterations at once, the first iterations find out whether that is faster: they run in all ways in turn, which leaves
// the same elements, and are timed.
#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/loop_runner.hpp"
#include "device/loop_state.hpp"
#include "device/loop_tiles.hpp"
#include "device/write_scope.hpp"
#include "gl_device/fuse/fused_loop.hpp"
#include "gl_device/fuse/tiled_calls.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/pass/replay.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

/// Iterations between two looks at the clock: a multiple of what tiles run at once.
constexpr std::int64_t timedIterations = 12;
/// The first round of a trial compiles programs and takes notes.
constexpr int warmRounds = 1, timedRounds = 3;
/// Passes over fewer elements take as long as it takes to start them, and the waits of a trial would cost more than it finds out.
constexpr std::int64_t fewElements = 1 << 16;
/// Tiles must be that many times as fast.
constexpr double leastGain = 1.05;
constexpr std::string_view slower = "they take {:.2f} times as long";
/// The most tiles that are tried.
constexpr std::size_t mostTried = 4;

class GlLoop final : public LoopRunner {
 public:
  explicit GlLoop(GlDevice& device)
      : device_(device),
        fused_(device),
        byIteration_(makeReplay(device, [this](LoopState& loop) { fused_.runOnce(loop); })) {}

  void run(LoopState& loop, std::int64_t times) override {
    analyse(loop);
    while (isTrying() && times >= timedIterations + after()) times -= tryOne(loop);
    if (chosen_ != nullptr) times -= runTiles(loop, *chosen_, (times - after()) / iterationsOf(*chosen_));
    if (times > 0) byIteration_->run(loop, times);
  }

  std::int64_t runUntil(LoopState& loop, const StreamRegion& done, const LoopEnd& end) override {
    return byIteration_->runUntil(loop, done, end);
  }

  std::string plan(LoopState& loop) override {
    analyse(loop);
    return fmt::format("{} calls, whose OpenGL commands are recorded and repeated{}\n", loop.calls().size(),
                       byIteration_->mayReplay()
                           ? ""
                           : ", which tracing, labels or calls with changing commands prevent here") +
           planOfTiles() + (chosen_ != nullptr ? "iterations that are left over:\n" : "") + fused_.plan(loop);
  }

 private:
  /// Tiles of one size.
  struct Tiles {
    std::unique_ptr<TiledIteration::Call> call;
    std::unique_ptr<Replay> replay;
    double best = std::numeric_limits<double>::infinity();  ///< seconds for timedIterations
  };

  std::int64_t after() const { return iteration_ ? iteration_->after() : 0; }
  static std::int64_t iterationsOf(const Tiles& tiles) { return tiles.call->plan().iterations; }
  bool isTrying() const { return !tried_.empty() && chosen_ == nullptr; }

  void analyse(LoopState& loop) {
    if (std::exchange(isAnalysed_, true)) return;
    const std::optional<std::int64_t> given = givenTileBytes();
    if (given == 0) {
      whyNot_ = "SK_LOOP_TILES is off";
      return;
    }
    iteration_ = std::make_unique<TiledIteration>(device_);
    whyNot_ = iteration_->analyse(loop);
    if (whyNot_.empty() && !given) whyNot_ = whyNotWorthwhile(loop);
    if (whyNot_.empty()) given ? take(static_cast<std::size_t>(*given)) : prepareTrial();
    if (!whyNot_.empty()) iteration_.reset();
  }

  /// Takes the first tiles that need at most this much shared memory.
  void take(std::size_t bytes) {
    addTiles(iteration_->plans(std::min(iteration_->groupBytes(), bytes)), 1);
    if (!tried_.empty()) chosen_ = &tried_.front();
  }

  /// Takes what a trial has found to be the fastest, or prepares one.
  void prepareTrial() {
    std::vector<assemble::TilePlan> plans = iteration_->plans(iteration_->groupBytes());
    const std::optional<TileVerdict> known = device_.programs().tileTrials().find(iteration_->identity());
    if (known && known->iterations == 0)
      return endWithout(fmt::format(fmt::runtime(slower), 1 / known->gain));
    if (known) {
      const auto fastest =
          std::ranges::find_if(plans, [&](const assemble::TilePlan& plan) { return known->isFor(plan); });
      if (fastest != plans.end()) {
        addTiles({*fastest}, 1);
        chosen_ = &tried_.front();
        gain_ = known->gain;
        return;
      }
    }
    addTiles(std::move(plans), mostTried);
  }

  std::string whyNotWorthwhile(const LoopState& loop) const {
    if (device_.isSoftware() && device_.target != Target::Compute)
      return "a renderer in software has no faster memory for them";
    const bool isSmall = std::ranges::all_of(
        loop.used(), [](const LoopState::Used& used) { return used.shape.size() < fewElements; });
    return isSmall ? "its streams are small" : "";
  }

  void addTiles(std::vector<assemble::TilePlan> plans, std::size_t most) {
    if (plans.empty()) whyNot_ = "a tile and all that is around it take too much of a work group's memory";
    plans.resize(std::min(plans.size(), most));
    tried_.reserve(plans.size());
    for (assemble::TilePlan& plan : plans) {
      Tiles& tiles = tried_.emplace_back();
      tiles.call = std::make_unique<TiledIteration::Call>(*iteration_, std::move(plan));
      const TiledIteration::Call& call = *tiles.call;
      tiles.replay = makeReplay(device_, [&call](LoopState&) { call.run(); });
    }
  }

  /// Runs tiles `times` times, and then the iterations call by call that must follow. Returns the number of iterations, which may
  /// be 0: a driver that refuses the program, or has no memory for it, ends tiles of this size.
  std::int64_t runTiles(LoopState& loop, Tiles& tiles, std::int64_t times) {
    if (times <= 0 || !iteration_->isPlane()) return 0;
    WriteScope stale;
    for (StreamState* const stream : iteration_->stale()) stale.add(stream);
    try {
      tiles.replay->run(loop, 1);
    } catch (const Error& error) {
      const bool isRefused = error.kind() == Error::Kind::Compile || error.kind() == Error::Kind::Memory;
      if (!isRefused || hasLost(loop)) throw;
      refuse(tiles);
      return 0;
    }
    stale.begin();
    tiles.replay->run(loop, times - 1);
    if (after() > 0) byIteration_->run(loop, after());
    stale.commit();
    return times * iterationsOf(tiles) + after();
  }

  static bool hasLost(const LoopState& loop) {
    return std::ranges::any_of(loop.used(),
                               [](const LoopState::Used& used) { return used.stream->isLost(); });
  }

  void refuse(Tiles& tiles) {
    if (chosen_ == &tiles) chosen_ = nullptr;
    std::erase_if(tried_, [&](const Tiles& other) { return &other == &tiles; });
    if (tried_.empty()) endWithout("the driver refuses the program of a tile");
  }

  void endWithout(std::string why) {
    chosen_ = nullptr;
    tried_.clear();
    whyNot_ = std::move(why);
  }

  /// One turn of the trial. Returns the number of iterations.
  std::int64_t tryOne(LoopState& loop) {
    const std::size_t turn = turn_++;
    if (turn == 0) {
      bestByIteration_ =
          std::min(bestByIteration_, seconds([&] { byIteration_->run(loop, timedIterations); }));
      return timedIterations;
    }
    Tiles& tiles = tried_[turn - 1];
    const std::size_t before = tried_.size();
    std::int64_t ran = 0;
    const double taken = seconds([&] { ran = runTiles(loop, tiles, timedIterations / iterationsOf(tiles)); });
    if (tried_.size() < before) {
      --turn_;
    } else if (ran == 0) {
      endWithout("its streams do not lie as planes");
    } else {
      tiles.best = std::min(tiles.best, taken * timedIterations / static_cast<double>(ran));
    }
    if (turn_ > tried_.size()) endRound();
    return ran;
  }

  void endRound() {
    turn_ = 0;
    ++round_;
    if (round_ == warmRounds) {  // what came before does not count
      bestByIteration_ = std::numeric_limits<double>::infinity();
      for (Tiles& tiles : tried_) tiles.best = std::numeric_limits<double>::infinity();
    }
    if (round_ < warmRounds + timedRounds || tried_.empty()) return;
    const auto fastest = std::ranges::min_element(tried_, {}, &Tiles::best);
    gain_ = bestByIteration_ / fastest->best;
    const assemble::TilePlan& plan = fastest->call->plan();
    const bool isFaster = gain_ >= leastGain;
    device_.programs().tileTrials().keep(
        iteration_->identity(), isFaster ? TileVerdict{plan.iterations, plan.texels, plan.invocations, gain_}
                                         : TileVerdict{.gain = gain_});
    if (!isFaster) return endWithout(fmt::format(fmt::runtime(slower), 1 / gain_));
    Tiles best = std::move(*fastest);
    tried_.clear();
    tried_.push_back(std::move(best));
    chosen_ = &tried_.front();
  }

  template <class Run>
  double seconds(Run&& run) {
    const bool isOnDevice = device_.beginMeasuring();
    if (!isOnDevice) device_.finish();
    const auto start = std::chrono::steady_clock::now();
    run();
    if (isOnDevice) return 1e-9 * static_cast<double>(device_.endMeasuring());
    device_.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  std::string planOfTiles() const {
    if (!whyNot_.empty()) return fmt::format("no tiles of several iterations: {}\n", whyNot_);
    if (chosen_ == nullptr)
      return fmt::format("{}: the first iterations find out whether tiles of several are faster\n",
                         iteration_->names());
    const assemble::TilePlan& plan = chosen_->call->plan();
    const std::string measured = gain_ > 0 ? fmt::format(", {:.2f} times as fast", gain_) : "";
    return fmt::format(
        "{}: in tiles of {} rows x {} columns, {} iterations at once, {:.1f} times fewer bytes from "
        "memory{}\n",
        iteration_->names(), plan.stored()[1], 4 * plan.stored()[0], plan.iterations,
        iteration_->bytesOfCalls() / iteration_->bytesOfTiles(plan), measured);
  }

  GlDevice& device_;
  FusedLoop fused_;
  std::unique_ptr<Replay> byIteration_;
  bool isAnalysed_ = false;
  std::string whyNot_;  ///< why there are no tiles
  std::unique_ptr<TiledIteration> iteration_;
  std::vector<Tiles> tried_;
  Tiles* chosen_ = nullptr;  ///< one of tried_, which is the fastest, or given
  std::size_t turn_ = 0;  ///< 0: iteration by iteration; else the number of tiles
  int round_ = 0;
  double bestByIteration_ = std::numeric_limits<double>::infinity(), gain_ = 0;
};

}  // namespace

std::unique_ptr<LoopRunner> GlDevice::makeLoopRunner() { return std::make_unique<GlLoop>(*this); }

}  // namespace sk
