// SPDX-License-Identifier: MIT
#include "native/local_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/loop_state.hpp"
#include "device/write_scope.hpp"
#include "native/memory.hpp"
#include "native/native_device.hpp"
#include "native/native_pass.hpp"
#include "native/per_worker.hpp"
#include "native/slot_arrays.hpp"
#include "native/thread_pool.hpp"
#include "native/tiled_call.hpp"
#include "sk/native/parallel.hpp"
#include "support/host_limits.hpp"

namespace sk {

namespace {

using native::Extents;
using native::Part;

/// A thread's elements of the local streams: an array for each component of each.
struct Scratch {
  std::vector<std::vector<ArrayMemory>> arrays;
};

class LocalTiles {
 public:
  LocalTiles(NativeDevice& device, LoopState& loop, std::span<StreamState* const> locals)
      : device_(device), loop_(loop) {
    for (StreamState* const local : locals) locals_.push_back({static_cast<NativeStream*>(local)});
  }

  bool run() {
    if (!prepare() || !findReach() || !choose()) return false;
    WriteScope writes;
    std::vector<native::Call> calls;
    for (const std::unique_ptr<TiledCall>& call : calls_) {
      for (const TiledCall::Use& use : call->uses()) {
        if (use.isWritten && localOf(use) == nullptr) writes.add(use.stream);
      }
      calls.push_back(call->withArrays());
    }
    const std::int64_t cost = std::int64_t{1} << 20;  // more than it takes to wake a thread
    const std::int64_t threads = native::threadsFor(tiles_, cost);
    PerWorker<Scratch> scratch(threads);
    for (std::int64_t t = 0; t < threads; ++t) allocate(scratch.of(static_cast<int>(t)));
    writes.begin();
    {
      const NativePass traced(device_, [&] { return record(); });
      native::inParallel(tiles_, cost, native::Deal::AsTheyCome, [&](native::Range range, int worker) {
        for (std::int64_t tile = range.begin; tile < range.end; ++tile)
          runTile(tile, calls, scratch.of(worker));
      });
    }
    for (const std::unique_ptr<TiledCall>& call : calls_) {
      for (NativeStream* const stream : call->replaced()) stream->exchange();
    }
    writes.commit();
    return true;
  }

 private:
  struct Local {
    NativeStream* stream;
    Extents around{};  ///< how many indices around a tile later calls read, in each dimension
    Extents most{};  ///< the largest of these
  };

  Local* localOf(const TiledCall::Use& use) {
    const auto found = std::ranges::find(locals_, use.stream, &Local::stream);
    return found == locals_.end() ? nullptr : &*found;
  }

  /// Finds the calls; false if one of them cannot run in tiles.
  bool prepare() {
    for (const std::unique_ptr<RecordedCall>& recorded : loop_.calls()) {
      const auto* const run = dynamic_cast<const PreparedRun*>(recorded->onDevice());
      if (run == nullptr) return false;
      calls_.push_back(std::make_unique<TiledCall>(*run));
      if (!calls_.back()->whyNot().empty()) return false;
    }
    extent_ = calls_.front()->extent();
    return std::ranges::all_of(calls_, [&](const std::unique_ptr<TiledCall>& call) {
      return call->extent() == extent_ && call->computed().first == Extents{} &&
             call->computed().extent == extent_;
    });
  }

  /// Finds how far around a tile each call computes, which may be anyDistance or more. False if tiles would see what others have written.
  bool findReach() {
    around_.assign(calls_.size(), Extents{});
    for (std::size_t i = calls_.size(); i-- > 0;) {
      bool writesLocal = false, writesOther = false;
      for (const TiledCall::Use& use : calls_[i]->uses()) {
        if (!use.isWritten) continue;
        Local* const local = localOf(use);
        (local != nullptr ? writesLocal : writesOther) = true;
        if (local == nullptr && isUsedBeside(use)) return false;
        if (local != nullptr) widen(around_[i], std::exchange(local->around, Extents{}));
      }
      if (writesLocal && writesOther) return false;
      for (const TiledCall::Use& use : calls_[i]->uses()) {
        Local* const local = localOf(use);
        if (local == nullptr || use.isWritten) continue;
        if (use.isSpare) return false;
        Extents distance = use.distance;
        for (std::size_t d = 0; d < 4; ++d) {
          // what a periodic gather reads at an end of the stream is at the other end
          if (distance[d] > 0 && use.wraps) distance[d] = native::anyDistance;
          distance[d] += around_[i][d];
        }
        widen(local->around, distance);
        widen(local->most, local->around);
      }
      if (std::ranges::any_of(calls_[i]->uses(), [&](const TiledCall::Use& use) {
            return use.isWritten && use.isSpare && localOf(use) != nullptr;
          }))
        return false;
    }
    return true;
  }

  static void widen(Extents& extents, const Extents& other) {
    for (std::size_t d = 0; d < 4; ++d) extents[d] = std::max(extents[d], other[d]);
  }

  /// True if another use, also in another call, has the array that this one writes.
  bool isUsedBeside(const TiledCall::Use& written) const {
    for (const std::unique_ptr<TiledCall>& call : calls_) {
      for (const TiledCall::Use& use : call->uses()) {
        if (&use == &written || use.stream != written.stream || use.isSpare != written.isSpare) continue;
        // a call may read the element that it writes
        const bool isSameCall =
            call->uses().data() <= &written && &written < call->uses().data() + call->uses().size();
        if (!isSameCall || use.isWritten || use.distance != Extents{}) return true;
      }
    }
    return false;
  }

  /// Chooses the length of tiles; false if they would gain nothing.
  bool choose() {
    std::vector<std::pair<NativeStream*, bool>> arrays;
    std::int64_t bytes = 0;
    for (const std::unique_ptr<TiledCall>& call : calls_) {
      for (const TiledCall::Use& use : call->uses()) {
        const std::pair<NativeStream*, bool> array{use.stream, use.isSpare};
        if (std::ranges::find(arrays, array) != arrays.end()) continue;
        arrays.push_back(array);
        bytes += use.stream->components.bytesOfElement();
      }
    }
    const std::int64_t elements = extent_[0] * extent_[1] * extent_[2] * extent_[3];
    const std::int64_t cache = native::cacheOfTile();
    if (cache == 0 || elements * bytes <= cache * native::mostThreads()) return false;
    for (const Local& local : locals_) widen(most_, local.most);
    double least = mostWork;
    for (std::size_t d = 4; d-- > 0;) {  // the fewest dimensions that save much
      if (extent_[d] == 1) continue;
      if (most_[d] >= native::anyDistance) break;
      ++cutAxes_;
      const std::optional<Cuts> cuts = cutsAlong(d, static_cast<double>(cache) / static_cast<double>(bytes));
      if (!cuts || cuts->work >= least) continue;
      least = cuts->work;
      counts_ = cuts->counts;
      if (least <= enoughWork) break;
    }
    tiles_ = counts_[0] * counts_[1] * counts_[2] * counts_[3];
    return least < mostWork;
  }

  /// Numbers of tiles along each dimension, and what they compute in elements for each of the domain.
  struct Cuts {
    Extents counts{1, 1, 1, 1};
    double work = 1;
  };
  static constexpr double enoughWork = 1.25, mostWork = 1.5;

  /// Cuts the slowest dimensions, down to `last`, so that `room` elements of all streams fit a tile; empty if they do not.
  std::optional<Cuts> cutsAlong(std::size_t last, double room) const {
    for (std::size_t d = 0; d < last; ++d) room /= static_cast<double>(extent_[d]);
    Cuts cuts;
    int left = cutAxes_;
    for (std::size_t d = last; d < 4; ++d) {  // the fastest first: the rest is for the slowest
      if (extent_[d] == 1) continue;
      constexpr double shortestRow = 256;
      double length = std::pow(room, 1.0 / left--);
      if (d == 0) length = std::max(length, shortestRow);
      if (length >= static_cast<double>(extent_[d])) {
        room /= static_cast<double>(extent_[d]);
        continue;
      }
      const double own = length - 2 * static_cast<double>(most_[d]);
      if (own < 1) return std::nullopt;
      room /= length;
      cuts.counts[d] = static_cast<std::int64_t>(std::ceil(static_cast<double>(extent_[d]) / own));
      cuts.work *= length / own;
    }
    return cuts;
  }

  /// The first index of a tile, by its number along each dimension.
  Extents cut(const Extents& number) const {
    Extents first;
    for (std::size_t d = 0; d < 4; ++d) first[d] = number[d] * extent_[d] / counts_[d];
    return first;
  }

  /// The number of a tile along each dimension.
  Extents numberOf(std::int64_t tile) const {
    Extents number;
    for (std::size_t d = 0; d < 4; ++d) {
      number[d] = tile % counts_[d];
      tile /= counts_[d];
    }
    return number;
  }

  /// The most elements of a local stream that a tile has along a dimension.
  std::int64_t lengthOf(const Local& local, std::size_t d) const {
    if (counts_[d] == 1) return extent_[d];
    return std::min((extent_[d] + counts_[d] - 1) / counts_[d] + 2 * local.most[d], extent_[d]);
  }

  void allocate(Scratch& scratch) const {
    for (const Local& local : locals_) {
      std::vector<ArrayMemory>& arrays = scratch.arrays.emplace_back();
      std::int64_t elements = 1;
      for (std::size_t d = 0; d < 4; ++d) elements *= lengthOf(local, d);
      elements += 2 * slackOf(local);
      for (const ComponentType& type : local.stream->components.types())
        arrays.push_back(allocated(static_cast<std::size_t>(elements) * type.storedBytes));
    }
  }

  /// Elements before and behind those of a tile, of which code may read some without using them.
  std::int64_t slackOf(const Local& local) const { return lengthOf(local, 0) + mostStaged; }

  void runTile(std::int64_t tile, std::span<const native::Call> calls, const Scratch& scratch) const {
    const Extents number = numberOf(tile), begin = cut(number);
    Extents next = number;
    for (std::int64_t& n : next) ++n;
    const Extents end = cut(next);
    for (std::size_t i = 0; i < calls.size(); ++i) {
      std::vector<native::Operand> operands(calls[i].operands.begin(), calls[i].operands.end());
      std::vector<std::vector<void*>> lists;
      lists.reserve(calls_[i]->uses().size());
      for (const TiledCall::Use& use : calls_[i]->uses()) {
        const auto found = std::ranges::find(locals_, use.stream, &Local::stream);
        if (found == locals_.end()) continue;
        native::Operand& operand = operands[use.operand];
        std::int64_t stride = 1, first = slackOf(*found);  // of the element at index 0, in the arrays
        for (std::size_t d = 0; d < 4; ++d) {
          if (operand.stride[d] != 0) operand.stride[d] = stride;
          const std::int64_t lowest =
              counts_[d] == 1 ? 0 : std::max<std::int64_t>(begin[d] - found->most[d], 0);
          first -= lowest * stride;
          stride *= lengthOf(*found, d);
        }
        std::vector<void*>& list = lists.emplace_back();
        const std::vector<ArrayMemory>& arrays =
            scratch.arrays[static_cast<std::size_t>(found - locals_.begin())];
        for (std::size_t c = 0; c < arrays.size(); ++c) {
          const auto bytes = static_cast<std::int64_t>(found->stream->components.types()[c].storedBytes);
          list.push_back(arrays[c].get() + first * bytes);
        }
        operand.components = list;
      }
      native::Call call = calls[i];
      call.operands = operands;
      Part box;
      for (std::size_t d = 0; d < 4; ++d) {
        const std::int64_t around = counts_[d] == 1 ? 0 : around_[i][d];
        box.first[d] = std::max<std::int64_t>(begin[d] - around, 0);
        box.extent[d] = std::min(end[d] + around, extent_[d]) - box.first[d];
      }
      BoxCode(calls_[i]->kernel(), call, calls_[i]->choice()).run(box);
    }
  }

  PassRecord record() const {
    std::string names, domain;
    for (const std::unique_ptr<TiledCall>& call : calls_)
      names += fmt::format("{}{}", names.empty() ? "" : " + ", call->name());
    for (std::size_t d = 4; d-- > 0;) {
      if (extent_[d] > 1 || d == 0) domain += fmt::format("{}{}", domain.empty() ? "" : " x ", extent_[d]);
    }
    std::int64_t read = 0, written = 0;
    for (const std::unique_ptr<TiledCall>& call : calls_) {
      for (const TiledCall::Use& use : call->uses()) {
        if (std::ranges::find(locals_, use.stream, &Local::stream) != locals_.end()) continue;
        (use.isWritten ? written : read) += use.stream->components.bytesOfElement();
      }
    }
    const std::int64_t elements = extent_[0] * extent_[1] * extent_[2] * extent_[3];
    return {std::move(names), fmt::format("{} tiles of a pipeline", tiles_),
            "native",         std::move(domain),
            elements * read,  elements * written};
  }

  NativeDevice& device_;
  LoopState& loop_;
  std::vector<Local> locals_;
  std::vector<std::unique_ptr<TiledCall>> calls_;
  Extents extent_{};
  std::vector<Extents> around_;  ///< by call: how far around a tile it computes
  Extents most_{};  ///< the largest, where that has a limit
  int cutAxes_ = 0;
  Extents counts_{1, 1, 1, 1};  ///< of tiles along each dimension
  std::int64_t tiles_ = 0;
};

}  // namespace

bool runInLocalTiles(NativeDevice& device, LoopState& calls, std::span<StreamState* const> locals) {
  return LocalTiles(device, calls, locals).run();
}

}  // namespace sk
