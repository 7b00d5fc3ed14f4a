// SPDX-License-Identifier: MIT
#include "native/tiled_loop.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/loop_state.hpp"
#include "device/loop_tiles.hpp"
#include "device/write_scope.hpp"
#include "native/native_device.hpp"
#include "native/native_pass.hpp"
#include "native/thread_pool.hpp"
#include "native/tiled_call.hpp"
#include "native/time_tiles.hpp"
#include "sk/native/parallel.hpp"
#include "support/host_limits.hpp"

namespace sk {

namespace {

using native::Extents;
using native::Part;
using native::TileAccess;
using native::TimeTiles;

/// Neighbouring calls that run together.
struct TiledGroup {
  std::size_t begin, end;  ///< their numbers in the loop
  std::vector<TiledCall*> calls;  ///< those of the loop from `begin` on, without idle ones
  std::optional<native::TileChoice> choice;  ///< empty if they run one by one
  std::int64_t bytesRead = 0, bytesWritten = 0;  ///< by tiles, once
};

/// Which arrays streams have during a loop, in numbers: swaps and replaced outputs move them.
class ArrayNumbers {
 public:
  std::size_t of(NativeStream* stream, bool isSpare) { return pairOf(stream)[isSpare ? 1 : 0]; }
  void replace(NativeStream* stream) {
    auto& arrays = pairOf(stream);
    std::swap(arrays[0], arrays[1]);
  }
  void exchange(NativeStream* a, NativeStream* b) {
    pairOf(a);
    pairOf(b);  // which may move the other
    std::swap(pairOf(a), pairOf(b));
  }
  void noteWritten(std::size_t array) {
    if (std::ranges::find(written_, array) == written_.end()) written_.push_back(array);
  }
  /// Calls visit(stream) for those whose own arrays calls have written.
  template <class Visit>
  void forEachWritten(Visit&& visit) const {
    for (const auto& [stream, arrays] : arrays_) {
      if (std::ranges::find(written_, arrays[0]) != written_.end()) visit(*stream);
    }
  }

 private:
  std::array<std::size_t, 2>& pairOf(NativeStream* stream) {
    const std::size_t next = 2 * arrays_.size();
    return arrays_.try_emplace(stream, std::array<std::size_t, 2>{next, next + 1}).first->second;
  }
  std::unordered_map<NativeStream*, std::array<std::size_t, 2>> arrays_;
  std::vector<std::size_t> written_;
};

/// The most states of its streams' arrays for which a call keeps its code.
constexpr std::size_t mostCodes = 16;

class TiledLoop final : public LoopRunner {
 public:
  explicit TiledLoop(NativeDevice& device) : device_(device) {}

  void run(LoopState& loop, std::int64_t times) override {
    if (times == 0) return;
    analyse(loop);
    if (spansIterations_) {
      const std::int64_t last = hasIdle_ ? 1 : 0;
      while (times > last) {
        const std::int64_t atOnce = groups_.front().choice->iterations;
        const std::int64_t blocks = (times - last + atOnce - 1) / atOnce;
        const std::int64_t now = (times - last + blocks - 1) / blocks;  // blocks of about equal length
        if (now == 1 && groups_.front().calls.size() == 1) {
          loop.runOnce();
        } else {
          runTiles(loop, groups_.front(), now);
        }
        times -= now;
      }
      for (; times > 0; --times) loop.runOnce();
      return;
    }
    for (; times > 0; --times) runByGroups(loop);
  }

  std::int64_t runUntil(LoopState& loop, const StreamRegion& done, const LoopEnd& end) override {
    return loop.runAndAsk(done, 1, end.most);
  }

  std::string plan(LoopState& loop) override;

 private:
  struct Call {
    std::unique_ptr<TiledCall> tiled;  ///< null if it runs as a whole
    std::string whyNot;
    bool isIdle = false;  ///< only its last run counts: nothing in the loop uses its results
  };
  /// A call of a tile.
  struct Step {
    const TiledCall* call;
    const BoxCode* code;
    Extents skew;
  };

  void analyse(LoopState& loop);
  void findIdle(const LoopState& loop);
  void findGroups(const LoopState& loop);
  void choose(const LoopState& loop, TiledGroup& group, std::int64_t mostIterations) const;
  std::string whyNotTogether(const TiledGroup& group, const TiledCall& call) const;

  template <class Visit>
  ArrayNumbers forEachCall(const LoopState& loop, const TiledGroup& group, std::int64_t iterations,
                           Visit&& visit) const;
  void runByGroups(LoopState& loop);
  void runTiles(LoopState& loop, TiledGroup& group, std::int64_t iterations);
  std::vector<Step> prepare(LoopState& loop, TiledGroup& group, std::int64_t iterations, WriteScope& writes);
  PassRecord recordOf(const TiledGroup& group, std::int64_t iterations) const;

  NativeDevice& device_;
  std::vector<Call> calls_;  ///< of the loop; empty until analyse()
  std::vector<TiledGroup> groups_;
  bool isAnalysed_ = false;
  bool hasIdle_ = false;
  bool spansIterations_ = false;  ///< there is one group, with all calls that are not idle
};

void TiledLoop::analyse(LoopState& loop) {
  if (isAnalysed_) return;
  calls_.clear();  // of an attempt that has thrown
  groups_.clear();
  spansIterations_ = false;
  for (const std::unique_ptr<RecordedCall>& recorded : loop.calls()) {
    Call& call = calls_.emplace_back();
    const auto* const run = dynamic_cast<const PreparedRun*>(recorded->onDevice());
    if (run == nullptr) {
      call.whyNot = recorded->whyNotOnDevice();
      continue;
    }
    call.tiled = std::make_unique<TiledCall>(*run);
    call.whyNot = call.tiled->whyNot();
    if (!call.whyNot.empty()) call.tiled.reset();
  }
  findIdle(loop);
  findGroups(loop);
  isAnalysed_ = true;
}

/// Finds calls whose results nothing in the loop uses, and that write them anew in each iteration.
void TiledLoop::findIdle(const LoopState& loop) {
  std::vector<std::vector<StreamUse>> uses(calls_.size());
  for (std::size_t i = 0; i < calls_.size(); ++i) {
    if (!loop.calls()[i]->addUses(uses[i])) return;
  }
  for (std::size_t i = 0; i < calls_.size(); ++i) {
    const auto isOnlyWrittenHere = [&](const StreamState* stream) {
      for (std::size_t k = 0; k < calls_.size(); ++k) {
        for (const StreamUse& use : uses[k]) {
          if (use.stream == stream && (!use.isWritten || k != i)) return false;
        }
      }
      return std::ranges::none_of(
          loop.exchanges(), [&](const auto& pair) { return pair.first == stream || pair.second == stream; });
    };
    const bool prints = calls_[i].tiled == nullptr && loop.calls()[i]->onDevice() != nullptr;
    calls_[i].isIdle = !prints && std::ranges::all_of(uses[i], [&](const StreamUse& use) {
      return !use.isWritten || isOnlyWrittenHere(use.stream);
    });
  }
}

std::string TiledLoop::whyNotTogether(const TiledGroup& group, const TiledCall& call) const {
  if (!group.calls.empty() && group.calls.front()->extent() != call.extent())
    return "its stream has another shape";
  // values are copied when a tile begins
  for (const TiledCall* const other : group.calls) {
    for (const auto& [reader, writer] : {std::pair(&call, other), std::pair(other, &call)}) {
      for (const NativeStream* const value : reader->values()) {
        if (std::ranges::any_of(writer->uses(), [&](const TiledCall::Use& use) {
              return use.isWritten && use.stream == value;
            }))
          return fmt::format("'{}' writes a value that '{}' reads", writer->name(), reader->name());
      }
    }
  }
  return {};
}

void TiledLoop::findGroups(const LoopState& loop) {
  bool areAllTiled = true;
  hasIdle_ = false;
  TiledGroup whole{0, calls_.size(), {}, {}};
  for (Call& call : calls_) {
    if (call.isIdle) {
      hasIdle_ = true;
      continue;
    }
    if (areAllTiled && call.tiled != nullptr) {
      const std::string why = whyNotTogether(whole, *call.tiled);
      areAllTiled = why.empty();
      whole.calls.push_back(call.tiled.get());
    } else {
      areAllTiled = false;
    }
  }
  const auto hasExchangedValue = [&](const TiledCall* call) {
    return std::ranges::any_of(call->values(), [&](const NativeStream* value) {
      return std::ranges::any_of(
          loop.exchanges(), [&](const auto& pair) { return pair.first == value || pair.second == value; });
    });
  };
  areAllTiled = areAllTiled && std::ranges::none_of(whole.calls, hasExchangedValue);
  if (areAllTiled && !whole.calls.empty()) {
    choose(loop, whole, std::numeric_limits<std::int64_t>::max());
    if (whole.choice && (whole.choice->iterations > 1 || !hasIdle_)) {
      spansIterations_ = true;
      groups_.push_back(std::move(whole));
      return;
    }
  }
  for (std::size_t i = 0; i < calls_.size(); ++i) {
    TiledCall* const tiled = calls_[i].tiled.get();
    const bool joins =
        tiled != nullptr && !groups_.empty() && groups_.back().end == i && !groups_.back().calls.empty();
    if (joins) {
      calls_[i].whyNot = whyNotTogether(groups_.back(), *tiled);
      if (calls_[i].whyNot.empty()) {
        groups_.back().calls.push_back(tiled);
        ++groups_.back().end;
        continue;
      }
    }
    TiledGroup& group = groups_.emplace_back(TiledGroup{i, i + 1, {}, {}});
    if (tiled != nullptr) group.calls.push_back(tiled);
  }
  for (TiledGroup& group : groups_) {
    if (group.calls.size() > 1) choose(loop, group, 1);
  }
}

/// Calls visit(call, accesses) for the calls of some iterations in order. Returns which arrays streams have then.
template <class Visit>
ArrayNumbers TiledLoop::forEachCall(const LoopState& loop, const TiledGroup& group, std::int64_t iterations,
                                    Visit&& visit) const {
  ArrayNumbers numbers;
  std::vector<TileAccess> accesses;
  for (std::int64_t n = 0; n < iterations; ++n) {
    for (TiledCall* const call : group.calls) {
      accesses.clear();
      for (const TiledCall::Use& use : call->uses()) {
        accesses.push_back({numbers.of(use.stream, use.isSpare), use.isWritten, use.distance});
        if (use.isWritten) numbers.noteWritten(accesses.back().array);
      }
      visit(*call, std::span<const TileAccess>(accesses));
      for (NativeStream* const stream : call->replaced()) numbers.replace(stream);
    }
    if (n + 1 == iterations && !spansIterations_) break;  // other calls come before the exchange
    for (const auto& [a, b] : loop.exchanges())
      numbers.exchange(static_cast<NativeStream*>(a), static_cast<NativeStream*>(b));
  }
  return numbers;
}

void TiledLoop::choose(const LoopState& loop, TiledGroup& group, std::int64_t mostIterations) const {
  native::TileProblem problem;
  problem.extent = group.calls.front()->extent();
  problem.threads = native::mostThreads();
  problem.mostIterations = mostIterations;
  struct Array {
    bool isRead = false, isWritten = false;
    std::int64_t bytes = 0;
  };
  std::unordered_map<std::size_t, Array> arrays;
  const std::int64_t two = std::min<std::int64_t>(mostIterations, 2);  // swaps alternate between two arrays
  forEachCall(loop, group, two, [&](const TiledCall& call, std::span<const TileAccess> accesses) {
    std::unordered_map<std::size_t, Array> ofCall;
    for (std::size_t i = 0; i < accesses.size(); ++i) {
      const std::int64_t bytes = call.uses()[i].stream->components.bytesOfElement();
      for (Array* const array : {&arrays[accesses[i].array], &ofCall[accesses[i].array]}) {
        array->bytes = bytes;
        (accesses[i].isWrite ? array->isWritten : array->isRead) = true;
      }
    }
    // what is written is read first, as caches do it
    for (const auto& [number, array] : ofCall)
      problem.bytesOfCalls += array.bytes * (array.isWritten ? 2 : 1);
    for (std::size_t d = 0; d < 4; ++d) problem.isPeriodic[d] = problem.isPeriodic[d] || call.isPeriodic(d);
  });
  problem.bytesOfCalls /= two;
  for (const auto& [number, array] : arrays) {
    problem.bytes += array.bytes;
    problem.bytesOfTiles += array.bytes * (array.isWritten ? 2 : 1);
    if (array.isWritten) group.bytesWritten += array.bytes;
    if (array.isRead) group.bytesRead += array.bytes;
  }
  problem.skew = [&](std::int64_t iterations) {
    native::Skews skews;
    forEachCall(loop, group, iterations,
                [&](const TiledCall&, std::span<const TileAccess> accesses) { skews.add(accesses); });
    return skews.most();
  };
  problem.cache = native::cacheOfTile(problem.skew(two) == Extents{});
  group.choice = native::chooseTiles(problem);
}

void TiledLoop::runByGroups(LoopState& loop) {
  for (TiledGroup& group : groups_) {
    if (group.choice) {
      runTiles(loop, group, 1);
    } else {
      for (std::size_t i = group.begin; i < group.end; ++i) loop.calls()[i]->run();
    }
  }
  loop.exchangeStreams();
}

/// Finds the code of all calls, and moves the streams' arrays as the calls do. If that throws, they are as before.
std::vector<TiledLoop::Step> TiledLoop::prepare(LoopState& loop, TiledGroup& group, std::int64_t iterations,
                                                WriteScope& writes) {
  std::vector<Step> steps;
  std::vector<std::pair<NativeStream*, NativeStream*>>
      moved;  // the second is null if it got its spare arrays
  native::Skews skews;
  std::vector<Extents> skewOf;
  const auto note = [&](const TiledCall&, std::span<const TileAccess> accesses) {
    skewOf.push_back(skews.add(accesses));
  };
  forEachCall(loop, group, iterations, note).forEachWritten([&](NativeStream& stream) {
    writes.add(&stream);
  });
  steps.reserve(skewOf.size());
  const std::size_t mostMoved = loop.exchanges().size() * static_cast<std::size_t>(iterations);
  try {
    for (std::int64_t n = 0; n < iterations; ++n) {
      for (TiledCall* const call : group.calls) {
        steps.push_back({call, &call->code(), skewOf[steps.size()]});
        moved.reserve(moved.size() + call->replaced().size() + mostMoved);
        for (NativeStream* const stream : call->replaced()) {
          stream->exchange();
          moved.emplace_back(stream, nullptr);
        }
      }
      if (!spansIterations_) break;
      for (const auto& [a, b] : loop.exchanges()) {
        a->exchangeElements(*b);
        moved.emplace_back(static_cast<NativeStream*>(a), static_cast<NativeStream*>(b));
      }
    }
  } catch (...) {
    for (std::size_t i = moved.size(); i-- > 0;) {
      const auto& [stream, other] = moved[i];
      other == nullptr ? stream->exchange() : stream->exchangeElements(*other);
    }
    throw;
  }
  return steps;
}

PassRecord TiledLoop::recordOf(const TiledGroup& group, std::int64_t iterations) const {
  std::string names;
  for (const TiledCall* const call : group.calls)
    names += fmt::format("{}{}", names.empty() ? "" : " + ", call->name());
  const Extents& extent = group.calls.front()->extent();
  const std::int64_t elements = extent[0] * extent[1] * extent[2] * extent[3];
  std::string domain;
  for (std::size_t d = 4; d-- > 0;) {
    if (extent[d] > 1 || d == 0) domain += fmt::format("{}{}", domain.empty() ? "" : " x ", extent[d]);
  }
  return {std::move(names),
          fmt::format("tiles of {} iterations", iterations),
          "native",
          std::move(domain),
          elements * group.bytesRead,
          elements * group.bytesWritten};
}

void TiledLoop::runTiles(LoopState& loop, TiledGroup& group, std::int64_t iterations) {
  for (TiledCall* const call : group.calls) {
    if (call->codes() > mostCodes) call->dropCode();  // the application has given streams new arrays
  }
  WriteScope writes;
  const std::vector<Step> steps = prepare(loop, group, iterations, writes);
  writes.begin();
  {
    const NativePass traced(device_, [&] { return recordOf(group, iterations); });
    const TimeTiles& tiles = group.choice->tiles;
    for (int phase = 0; phase < tiles.phases(); ++phase) {
      const std::int64_t count = tiles.tilesOf(phase);
      const std::int64_t cost = std::int64_t{1} << 20;  // more than it takes to wake a thread
      native::inParallel(count, cost, native::Deal::AsTheyCome, [&](native::Range range) {
        for (std::int64_t tile = range.begin; tile < range.end; ++tile) {
          for (const Step& step : steps) {
            tiles.forEachBox(phase, tile, step.skew,
                             [&](const Part& box) { step.call->run(*step.code, box); });
          }
        }
      });
    }
  }
  writes.commit();
}

std::string TiledLoop::plan(LoopState& loop) {
  analyse(loop);
  std::string text;
  const auto describe = [&](const TiledGroup& group) {
    std::string names;
    for (const TiledCall* const call : group.calls)
      names += fmt::format("{}{}", names.empty() ? "" : ", ", call->name());
    text += fmt::format("{}: in tiles of ", names);
    const char* separator = "";
    for (const TimeTiles::Axis& axis : group.choice->tiles.axes()) {
      text += fmt::format("{}{} {}", separator, group.choice->tiles.length(axis),
                          std::array{"columns", "rows", "planes", "blocks"}[axis.dimension]);
      separator = " x ";
    }
    text +=
        fmt::format(", {} iteration{} at once, {:.1f} times fewer bytes from memory\n",
                    group.choice->iterations, group.choice->iterations == 1 ? "" : "s", group.choice->gain);
  };
  for (const TiledGroup& group : groups_) {
    if (group.choice) {
      describe(group);
      continue;
    }
    for (std::size_t i = group.begin; i < group.end; ++i) {
      text += fmt::format("{}: by itself", loop.calls()[i]->name());
      const std::string& why = calls_[i].whyNot;
      text += why.empty() ? ", since tiles of it would save no time\n" : fmt::format(", since {}\n", why);
    }
  }
  for (std::size_t i = 0; spansIterations_ && i < calls_.size(); ++i) {
    if (calls_[i].isIdle)
      text += fmt::format("{}: in the last iteration alone, since the loop uses none of its results\n",
                          loop.calls()[i]->name());
  }
  return text;
}

}  // namespace

std::unique_ptr<LoopRunner> makeTiledLoop(NativeDevice& device) {
  return std::make_unique<TiledLoop>(device);
}

}  // namespace sk
