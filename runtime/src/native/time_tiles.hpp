// SPDX-License-Identifier: MIT
//
// Divides the calls of several iterations of a loop into tiles, each of which a thread computes from the first call to the
// last, so that its elements stay in the cache (split tiling: Grosser and others, 2013). Every element is computed once, from
// the values that it has call by call.
//
// Along an axis, cuts divide the indices. A tile between two cuts shrinks from call to call by as much as the calls reach, so
// that it needs nothing that its neighbours compute. What it leaves out at a cut is a tile of the next phase: it grows from
// call to call, and no two of them meet. With several axes, a tile lies between cuts or at a cut along each of them.
//
//   time
//    ^     /      \          /      \           : between cuts, first phase
//    |    /        \   at   /        \   at
//    |   /  between \ the  /  between \  the    : at cuts, second phase
//    |  /            \cut /            \ cut
//    +-----------------------------------------> index
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "native/call.hpp"

namespace sk::native {

/// A distance that no axis has.
inline constexpr std::int64_t anyDistance = std::int64_t{1} << 40;

/// What a call reads or writes of one array.
struct TileAccess {
  std::size_t array;  ///< its number among the arrays of the loop
  bool isWrite;
  /// The most that the index of an element may differ from that of the one that is computed, in each dimension.
  Extents distance{};
};

/// By how much tiles shrink: calls are added in the order in which they run.
class Skews {
 public:
  /// The skew of the next call: it uses no element of an array that an earlier call writes, or writes one that an earlier call
  /// uses, but within this of it. Above anyDistance where there is no limit.
  Extents add(std::span<const TileAccess> accesses);
  /// The largest of all calls.
  const Extents& most() const { return most_; }

 private:
  struct Used {
    bool isWritten = false, isUsed = false;
    Extents written{}, used{};  ///< skew and distance of the calls so far
  };
  std::vector<Used> arrays_;
  Extents most_{};
};

/// The tiles of a box of indices from 0 on.
class TimeTiles {
 public:
  struct Axis {
    std::size_t dimension;
    std::int64_t count;  ///< of tiles between cuts
    bool isPeriodic;  ///< its ends are neighbours: there is a cut between them
  };

  /// Tiles must be at least twice as long as the largest skew along each axis.
  TimeTiles(const Extents& extent, std::vector<Axis> axes) : extent_(extent), axes_(std::move(axes)) {}

  std::span<const Axis> axes() const { return axes_; }
  /// The least length of a tile along an axis.
  std::int64_t length(const Axis& axis) const { return extent_[axis.dimension] / axis.count; }

  /// The phases, in order. Tiles of one phase are independent of each other.
  int phases() const { return 1 << axes_.size(); }
  std::int64_t tilesOf(int phase) const;
  /// Calls visit(box) for what a tile computes of a call with this skew: at most 2 boxes for each periodic axis.
  template <class Visit>
  void forEachBox(int phase, std::int64_t tile, const Extents& skew, Visit&& visit) const {
    Part box{.extent = extent_};
    visitAxis(cutAxes(phase), 0, tile, skew, box, visit);
  }

 private:
  /// Bit a: tiles of the phase lie at cuts of axis a.
  unsigned cutAxes(int phase) const;
  std::int64_t tilesAlong(const Axis& axis, bool atCuts) const {
    return atCuts ? axis.count - (axis.isPeriodic ? 0 : 1) : axis.count;
  }
  std::int64_t cut(const Axis& axis, std::int64_t number) const {
    return number * extent_[axis.dimension] / axis.count;
  }

  template <class Visit>
  void visitAxis(unsigned atCuts, std::size_t a, std::int64_t tile, const Extents& skew, Part& box,
                 Visit& visit) const {
    if (a == axes_.size()) {
      visit(std::as_const(box));
      return;
    }
    const Axis& axis = axes_[a];
    const std::size_t d = axis.dimension;
    const bool atCut = (atCuts >> a & 1) != 0;
    const std::int64_t tiles = tilesAlong(axis, atCut), number = tile % tiles;
    const auto within = [&](std::int64_t begin, std::int64_t end) {
      if (begin >= end) return;
      box.first[d] = begin;
      box.extent[d] = end - begin;
      visitAxis(atCuts, a + 1, tile / tiles, skew, box, visit);
    };
    if (!atCut) {
      const bool hasLeft = axis.isPeriodic || number > 0;
      const bool hasRight = axis.isPeriodic || number + 1 < axis.count;
      within(cut(axis, number) + (hasLeft ? skew[d] : 0), cut(axis, number + 1) - (hasRight ? skew[d] : 0));
    } else if (axis.isPeriodic && number == 0) {
      within(0, skew[d]);
      within(extent_[d] - skew[d], extent_[d]);
    } else {
      const std::int64_t at = cut(axis, axis.isPeriodic ? number : number + 1);
      within(at - skew[d], at + skew[d]);
    }
  }

  Extents extent_;
  std::vector<Axis> axes_;
};

/// What decides on tiles.
struct TileProblem {
  Extents extent{1, 1, 1, 1};  ///< of the indices of all calls
  std::array<bool, 4> isPeriodic{};
  std::int64_t bytes = 0;  ///< of all arrays, per index
  std::int64_t bytesOfTiles =
      0;  ///< that pass between memory and caches if tiles use each array once, per index
  std::int64_t bytesOfCalls = 0;  ///< if the calls of an iteration run one by one, per index
  std::int64_t cache = 0;  ///< bytes that a thread's tile may take
  int threads = 1;
  std::int64_t mostIterations = 1;
  /// The largest skew of that many iterations.
  std::function<Extents(std::int64_t iterations)> skew;
};

struct TileChoice {
  TimeTiles tiles;
  std::int64_t iterations;  ///< that tiles compute at once
  double gain;  ///< bytes from memory that calls move one by one, over those that tiles move
};

/// The best tiles; nullopt if the streams stay in the caches as they are, or if tiles save little.
std::optional<TileChoice> chooseTiles(const TileProblem& problem);

/// Bytes of the cache that a thread's tile may take: SK_LOOP_TILES says how many, 0 if it is "off". Throws sk::Error if it says something else. `isChain`: each element is computed
/// from itself alone, so that tiles of any size save as much.
std::int64_t cacheOfTile(bool isChain = false);

}  // namespace sk::native
