// SPDX-License-Identifier: MIT
//
// Takes notes until the streams' textures are again where they were before an earlier iteration: swaps, and outputs that
// are drawn to a second texture, move them. From then on the logs of this cycle are run in place of the calls, each followed by a
// gate (gl/loop_gate.hpp) in a loop with a condition. Whatever makes the textures differ from what the logs expect begins a
// new cycle. What is said of an iteration holds for whatever is repeated.
#include "gl_device/pass/replay.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/loop_state.hpp"
#include "device/write_scope.hpp"
#include "gl/command_log.hpp"
#include "gl/commands.hpp"
#include "gl/loop_gate.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

/// The longest cycle, and how many iterations may do what a log cannot hold: the first ones compile programs and
/// measure which target is faster.
constexpr std::size_t mostIterations = 128;
constexpr int mostSpoiled = 4;

class NotedReplay final : public Replay {
 public:
  NotedReplay(GlDevice& device, std::function<void(LoopState&)> once)
      : device_(device),
        once_(std::move(once)),
        hasGate_(device.capabilities.hasCompute &&
                 (device.traits.endsLoops || device.target == Target::Compute)) {}
  ~NotedReplay() override { drop(); }

  void run(LoopState& loop, std::int64_t times) override {
    while (times > 0) {
      if (replay(loop, times)) return;
      step(loop);
      --times;
    }
  }

  std::int64_t runUntil(LoopState& loop, const StreamRegion& done, const LoopEnd& end) override {
    const bool isExact = device_.capabilities.hasCompute || device_.isSoftware();
    const std::int64_t every = isExact ? 1 : end.every;
    std::int64_t ran = 0;
    bool isDone = false;
    while (!isDone && ran < end.most) {
      if (const auto gated = replayUntil(loop, done, end.every, end.most - ran)) {
        ran += gated->ran;
        isDone = gated->isDone;
        continue;
      }
      const std::int64_t times = std::min(every, end.most - ran);
      run(loop, times);
      ran += times;
      isDone = isTrue(done);
    }
    return ran;
  }

  bool mayReplay() const override {
    return !device_.trace && !device_.context().labels().isOn() && spoiled_ < mostSpoiled;
  }

 private:
  /// Where the textures of the loop's streams are: their names, plane by plane, and the layouts in them.
  struct Places {
    std::vector<GLuint> textures;
    std::vector<Layout> layouts;
  };
  struct Iteration {
    Places before;
    gl::CommandLog log;
    bool hasDrawnBefore = false, hasDrawnAfter = false;  ///< GlPasses::hasDrawn()
    PassCount passes;
  };

  /// To read one of several elements from the host may move all of them to other textures, so that no cycle would
  /// close. A pass copies it to a stream of its own first.
  bool isTrue(const StreamRegion& done) {
    if (done.stream->shape.size() == 1) return LoopState::isTrue(done);
    checkElementsOf(done, false, "until");
    if (!condition_) condition_ = device_.createStream(*done.stream->element, {1}, Storage::Single);
    ScalarPass pass;
    pass.reads.push_back(done);
    pass.steps.push_back({detail::ScalarOp::Copy, program::Scalar::Bool, condition_->element, {}});
    pass.outputs.push_back({condition_.get(), 0});
    device_.prepareScalars(std::move(pass))->run();
    return LoopState::isTrue({condition_.get(), Index::origin(1), condition_->shape});
  }

  static Places placesOf(const LoopState& loop) {
    Places places;
    for (const LoopState::Used& used : loop.used()) {
      const auto& stream = static_cast<const GlStream&>(*used.stream);
      for (const RenderTarget& plane : stream.planes) places.textures.push_back(plane.texture.name());
      places.layouts.push_back(stream.layout);
    }
    return places;
  }

  bool areAt(const LoopState& loop, const Places& places) const {
    auto next = places.textures.begin();
    for (const LoopState::Used& used : loop.used()) {
      for (const RenderTarget& plane : static_cast<const GlStream&>(*used.stream).planes) {
        if (next == places.textures.end() || *next++ != plane.texture.name()) return false;
      }
    }
    return next == places.textures.end();
  }

  /// Runs one iteration, and notes its commands.
  void step(LoopState& loop) {
    if (!mayReplay()) {
      drop();
      return once_(loop);
    }
    if (isClosed_ || isStale() || (!cycle_.empty() && !areAt(loop, last_))) drop();
    if (!std::exchange(hasRun_, true)) return once_(loop);
    Iteration& iteration = cycle_.emplace_back();
    device_.bound().keep(iteration.log);
    try {
      iteration.before = placesOf(loop);
      note(loop, iteration);
      last_ = placesOf(loop);
    } catch (...) {
      drop();
      throw;
    }
    if (iteration.log.isSpoiled() || reserve_.hasOverflown) {
      ++spoiled_;
      return drop();
    }
    closeCycle();
    if (!isClosed_ && cycle_.size() == mostIterations) spoiled_ = mostSpoiled;
  }

  void note(LoopState& loop, Iteration& iteration) {
    const std::optional<PassCount> counted = std::exchange(device_.passCount, PassCount{});
    iteration.hasDrawnBefore = device_.passes().hasDrawn();
    device_.bound().logTo(&iteration.log);
    reserve_.ofEarlier = reserve_.idle.size();
    device_.memory().pool().use(&reserve_);
    const auto end = [&] {
      device_.memory().pool().use(nullptr);
      device_.bound().logTo(nullptr);
      iteration.passes = *std::exchange(device_.passCount, counted);
      count(iteration.passes);
    };
    try {
      once_(loop);
    } catch (...) {
      end();
      throw;
    }
    end();
    iteration.hasDrawnAfter = device_.passes().hasDrawn();
  }

  /// Counts the passes of `times` iterations from the `first` of the cycle on.
  void count(std::size_t first, std::int64_t times) {
    if (!device_.passCount) return;
    for (std::int64_t i = 0; i < times; ++i) {
      count(cycle_[(first + static_cast<std::size_t>(i)) % cycle_.size()].passes);
    }
  }
  void count(const PassCount& passes) {
    if (!device_.passCount) return;
    device_.passCount->passes += passes.passes;
    device_.passCount->bytesRead += passes.bytesRead;
    device_.passCount->bytesWritten += passes.bytesWritten;
  }

  /// If the textures are again where they were, forgets the iterations before that.
  void closeCycle() {
    const auto start = std::ranges::find_if(
        cycle_, [&](const Iteration& iteration) { return iteration.before.textures == last_.textures; });
    if (start == cycle_.end()) return;
    for (const Iteration* const first = &*start; &cycle_.front() != first; cycle_.pop_front()) {
      device_.bound().drop(cycle_.front().log);
    }
    std::vector<gl::CommandLog*> logs;
    for (Iteration& iteration : cycle_) logs.push_back(&iteration.log);
    gl::CommandLog::findChanges(logs);
    groups_.clear();
    for (gl::CommandLog* const log : logs) log->setGroups(groups_);
    isClosed_ = true;
  }

  bool isStale() const {
    return std::ranges::any_of(cycle_, [](const Iteration& iteration) { return iteration.log.isStale(); });
  }

  void drop() noexcept {
    for (Iteration& iteration : cycle_) device_.bound().drop(iteration.log);
    cycle_.clear();
    isClosed_ = false;
    device_.memory().pool().release(reserve_);
  }

  /// The iteration of the cycle that comes next, if there is one. A DeviceScope must be open, which has made known
  /// what has been deleted.
  std::optional<std::size_t> next(const LoopState& loop) const {
    if (!isClosed_ || !mayReplay() || isStale()) return std::nullopt;
    for (std::size_t i = 0; i < cycle_.size(); ++i) {
      if (areAt(loop, cycle_[i].before)) return i;
    }
    return std::nullopt;
  }

  /// Gives the commands of an iteration by `how`, a member of its log.
  template <class How, class... What>
  void give(const Iteration& iteration, How how, const What&... what) {
    if (!iteration.hasDrawnBefore) device_.passes().orderAfterDraws();
    (iteration.log.*how)(device_.bound(), what...);
    device_.passes().setDrawn(iteration.hasDrawnAfter);
  }

  bool replay(LoopState& loop, std::int64_t times) {
    if (!isClosed_) return false;
    const DeviceScope scope(device_);
    const std::optional<std::size_t> first = next(loop);
    if (!first) return false;
    prepareToPlace(loop);
    device_.passes().loopReports().repeat(device_.context());
    std::size_t at = *first;
    for (std::int64_t i = 0; i < times; ++i) {
      const bool isAgain = i >= static_cast<std::int64_t>(cycle_.size());
      give(cycle_[at], isAgain ? &gl::CommandLog::runAgain : &gl::CommandLog::run);
      at = at + 1 < cycle_.size() ? at + 1 : 0;
    }
    count(*first, times);
    place(loop, cycle_[at].before);
    return true;
  }

  /// The iteration's condition, in the texture that its stream has after it; none if that is layered.
  std::optional<gl::LoopGate::Condition> conditionAfter(const LoopState& loop, std::size_t iteration,
                                                        const StreamRegion& done) const {
    const Places& after = cycle_[(iteration + 1) % cycle_.size()].before;
    const auto& stream = static_cast<const GlStream&>(*done.stream);
    if (stream.planes.front().texture.isLayered()) return std::nullopt;
    gl::LoopGate::Condition condition{.texture = stream.planes.front().texture.name()};
    const Layout* layout = &stream.layout;
    std::size_t plane = 0;
    for (std::size_t i = 0; i < loop.used().size(); ++i) {
      const auto& used = static_cast<const GlStream&>(*loop.used()[i].stream);
      if (&used == &stream) {
        condition.texture = after.textures[plane];
        layout = &after.layouts[i];
      }
      plane += used.planes.size();
    }
    const assemble::RegionLayout element = texelOf(regionLayoutOf(done, *layout));
    const GLint x = element.origin[0];
    condition.place =
        element.packed ? std::array{x / 4, element.origin[1], x % 4} : std::array{x, element.origin[1], 0};
    return condition;
  }

  std::optional<std::vector<gl::LoopGate::Condition>> conditions(const LoopState& loop,
                                                                 const StreamRegion& done) const {
    std::vector<gl::LoopGate::Condition> all;
    for (std::size_t i = 0; i < cycle_.size(); ++i) {
      const auto one = conditionAfter(loop, i, done);
      if (!one) return std::nullopt;
      all.push_back(*one);
    }
    return all;
  }

  /// Runs at most `most` iterations, which end by themselves. None if the device or the loop does not allow it.
  std::optional<gl::LoopGate::State> replayUntil(LoopState& loop, const StreamRegion& done,
                                                 std::int64_t every, std::int64_t most) {
    if (!isClosed_ || !hasGate_) return std::nullopt;
    checkElementsOf(done, false, "until");
    const DeviceScope scope(device_);
    const std::optional<std::size_t> first = next(loop);
    if (!first) return std::nullopt;
    const auto all = conditions(loop, done);
    if (!all) return std::nullopt;
    prepareToPlace(loop);
    device_.passes().loopReports().repeat(device_.context());
    WriteScope writes;
    for (const LoopState::Used& used : loop.used()) writes.add(used.stream);
    std::string log;
    hasGate_ = gate_.open(device_.bound(), groups_, device_.context().isGuest(), log);
    if (!hasGate_) return std::nullopt;
    const gl::IndirectCounts counts = gate_.counts();
    gl::LoopGate::State state;
    std::int64_t given = 0;
    const auto giveSome = [&] {
      const std::int64_t times = std::min(every, most - given);
      for (std::int64_t i = 0; i < times; ++i, ++given) {
        const std::size_t at = (*first + static_cast<std::size_t>(given)) % cycle_.size();
        give(cycle_[at], &gl::CommandLog::runIndirect, counts);
        gate_.pass(device_.bound(), (*all)[at], device_.passes().samplers().nearest());
      }
      gate_.ask(device_.bound());
    };
    writes.begin();
    try {
      // the device has commands while the host waits for what it answered before
      giveSome();
      while (given < most && !state.isDone) {
        giveSome();
        state = gate_.answerBefore(device_.bound());
      }
      if (given == most || state.isDone) state = gate_.lastAnswer(device_.bound());
    } catch (...) {
      gate_.close(device_.bound());
      throw;
    }
    gate_.close(device_.bound());
    if (!state.isDone && state.ran != given) {  // nobody knows which iterations have run
      hasGate_ = false;
      device_.throwPendingError();
      throw Error(fmt::format("a loop: '{}' has ended it after {} of {} iterations, without a reason; its "
                              "streams are lost; write "
                              "them and run it again, which takes another way on this device",
                              device_.name(), state.ran, given),
                  Error::Kind::Lost);
    }
    count(*first, state.ran);
    place(loop, cycle_[(*first + static_cast<std::size_t>(state.ran)) % cycle_.size()].before);
    writes.commit();
    return state;
  }

  /// Makes room for what place() writes.
  void prepareToPlace(const LoopState& loop) {
    scratch_.reserve(last_.textures.size() + reserve_.idle.size());
    for (std::size_t i = 0; i < loop.used().size(); ++i) {
      auto& draws = static_cast<GlStream&>(*loop.used()[i].stream).layout.draws;
      for (const Iteration& iteration : cycle_) draws.reserve(iteration.before.layouts[i].draws.size());
    }
  }

  /// Moves the textures to where they are before an iteration of the cycle. What the driver may report later concerns
  /// all streams of the loop.
  void place(LoopState& loop, const Places& places) noexcept {
    for (const LoopState::Used& used : loop.used()) {
      auto& planes = static_cast<GlStream&>(*used.stream).planes;
      for (RenderTarget& plane : planes) scratch_.push_back(std::move(plane));
    }
    for (RenderTarget& idle : reserve_.idle) scratch_.push_back(std::move(idle));
    reserve_.idle.clear();
    std::size_t next = 0;
    for (std::size_t i = 0; i < loop.used().size(); ++i) {
      auto& stream = static_cast<GlStream&>(*loop.used()[i].stream);
      for (RenderTarget& plane : stream.planes) {
        const GLuint name = places.textures[next++];
        plane = std::move(*std::ranges::find_if(
            scratch_, [&](const RenderTarget& one) { return one.texture.name() == name; }));
      }
      stream.layout = places.layouts[i];
      stream.setWritten();
    }
    for (RenderTarget& rest : scratch_) {
      if (rest) reserve_.idle.push_back(std::move(rest));
    }
    scratch_.clear();
  }

  GlDevice& device_;
  const std::function<void(LoopState&)> once_;
  std::deque<Iteration> cycle_;
  Places last_;  ///< after the last iteration of cycle_
  bool isClosed_ = false;  ///< last_ is before cycle_.front()
  bool hasRun_ = false;
  /// The device ends loops by itself. In software it would wait for itself where it draws; the host asks it after each
  /// iteration, for nothing.
  bool hasGate_;
  int spoiled_ = 0;
  TexturePool::Reserve reserve_;
  std::vector<gl::CommandLog::Groups> groups_;  ///< of the cycle's dispatches
  gl::LoopGate gate_;
  std::unique_ptr<StreamState> condition_;
  std::vector<RenderTarget> scratch_;
};

}  // namespace

std::unique_ptr<Replay> makeReplay(GlDevice& device, std::function<void(LoopState&)> once) {
  return std::make_unique<NotedReplay>(device, std::move(once));
}

}  // namespace sk
