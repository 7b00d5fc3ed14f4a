// SPDX-License-Identifier: MIT
#include "native/time_tiles.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "device/loop_tiles.hpp"
#include "native/thread_pool.hpp"
#include "support/host_limits.hpp"

namespace sk::native {

Extents Skews::add(std::span<const TileAccess> accesses) {
  Extents skew{};
  for (const TileAccess& access : accesses) {
    if (access.array >= arrays_.size()) arrays_.resize(access.array + 1);
    const Used& used = arrays_[access.array];
    if (!(access.isWrite ? used.isUsed : used.isWritten)) continue;
    const Extents& before = access.isWrite ? used.used : used.written;
    for (std::size_t d = 0; d < skew.size(); ++d) skew[d] = std::max(skew[d], before[d] + access.distance[d]);
  }
  for (const TileAccess& access : accesses) {
    Used& used = arrays_[access.array];
    used.isUsed = true;
    used.isWritten = used.isWritten || access.isWrite;
    for (std::size_t d = 0; d < skew.size(); ++d) {
      const std::int64_t reached = std::min(skew[d] + access.distance[d], 4 * anyDistance);
      used.used[d] = std::max(used.used[d], reached);
      if (access.isWrite) used.written[d] = std::max(used.written[d], reached);
    }
  }
  for (std::size_t d = 0; d < skew.size(); ++d) most_[d] = std::max(most_[d], skew[d]);
  return skew;
}

std::int64_t TimeTiles::tilesOf(int phase) const {
  const unsigned atCuts = cutAxes(phase);
  std::int64_t tiles = 1;
  for (std::size_t a = 0; a < axes_.size(); ++a) tiles *= tilesAlong(axes_[a], (atCuts >> a & 1) != 0);
  return tiles;
}

/// All subsets of the axes, smaller ones first.
unsigned TimeTiles::cutAxes(int phase) const {
  int before = 0;
  for (std::size_t size = 0; size <= axes_.size(); ++size) {
    for (unsigned set = 0; set < 1U << axes_.size(); ++set) {
      if (static_cast<std::size_t>(std::popcount(set)) == size && before++ == phase) return set;
    }
  }
  return 0;
}

namespace {

/// Rows shorter than this cost more by the elements at their ends.
constexpr std::int64_t shortestRow = 512;
constexpr std::int64_t mostIterationsOfTile = 32;
constexpr double leastGain = 1.3;

/// The lengths of tiles along the first `count` of these dimensions, slowest first, that fit the cache; empty if none do.
std::vector<std::int64_t> lengthsOf(const TileProblem& problem, std::span<const std::size_t> dimensions,
                                    std::size_t count) {
  std::int64_t others = 1;
  for (const std::size_t d : dimensions.subspan(count)) others *= problem.extent[d];
  double room =
      static_cast<double>(problem.cache) / static_cast<double>(problem.bytes) / static_cast<double>(others);
  std::vector<std::int64_t> lengths(count);
  std::size_t left = count;
  if (dimensions[count - 1] == 0) {  // rows are divided, too
    const double even = std::pow(room, 1.0 / static_cast<double>(count));
    const auto row =
        std::min(problem.extent[0], std::max(static_cast<std::int64_t>(even), count == 1 ? 1 : shortestRow));
    lengths[--left] = row;
    room /= static_cast<double>(std::max<std::int64_t>(row, 1));
  }
  for (std::size_t k = left; k-- > 0;) {  // the fastest first: the rest is for the slowest
    const auto even = static_cast<std::int64_t>(std::pow(room, 1.0 / static_cast<double>(k + 1)));
    lengths[k] = std::min(problem.extent[dimensions[k]], even);
    room /= static_cast<double>(std::max<std::int64_t>(lengths[k], 1));
  }
  if (std::ranges::any_of(lengths, [](std::int64_t length) { return length < 1; })) return {};
  return lengths;
}

/// The most tiles of at least these lengths along the axes, or more of them where threads would have none.
std::vector<TimeTiles::Axis> axesOf(const TileProblem& problem, std::span<const std::size_t> dimensions,
                                    std::span<const std::int64_t> lengths) {
  std::vector<TimeTiles::Axis> axes;
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    const std::size_t d = dimensions[k];
    std::int64_t count = std::max<std::int64_t>(1, problem.extent[d] / lengths[k]);
    if (k == 0) count = std::max(count, std::min<std::int64_t>(4 * problem.threads, problem.extent[d]));
    axes.push_back({d, count, problem.isPeriodic[d]});
  }
  return axes;
}

std::optional<TileChoice> choiceAlong(const TileProblem& problem, std::span<const std::size_t> dimensions,
                                      std::size_t count) {
  const std::vector<std::int64_t> lengths = lengthsOf(problem, dimensions, count);
  if (lengths.empty()) return std::nullopt;
  TimeTiles tiles(problem.extent, axesOf(problem, dimensions, lengths));
  std::optional<TileChoice> best;
  for (std::int64_t n = 1; n <= std::min(problem.mostIterations, mostIterationsOfTile); ++n) {
    const Extents skew = problem.skew(n);
    double passes = 1;  // how often an element comes from memory
    bool fits = true;
    for (const TimeTiles::Axis& axis : tiles.axes()) {
      const std::int64_t both = 2 * skew[axis.dimension];
      fits = fits && both <= tiles.length(axis);
      passes *= 1 + static_cast<double>(both) / static_cast<double>(tiles.length(axis));
    }
    if (!fits) break;
    const double gain =
        static_cast<double>(n * problem.bytesOfCalls) / (passes * static_cast<double>(problem.bytesOfTiles));
    if (!best || gain > best->gain) best.emplace(tiles, n, gain);
  }
  return best;
}

}  // namespace

std::int64_t cacheOfTile(bool isChain) {
  if (const auto given = givenTileBytes()) return *given;
  if (isChain) {
    constexpr std::int64_t nearest = 48 << 10;
    const std::int64_t first = bytesOfCache(1);
    return (first > 0 ? first : nearest) * 2 / 3;
  }
  // Tiles of less than `enough` are so short that they save less than the third level's slower answers cost.
  constexpr std::int64_t usual = 1 << 20, enough = 5 << 18;
  const std::int64_t found = bytesOfCache(2);
  const std::int64_t own = (found > 0 ? found : usual) * 5 / 8;
  return std::max(own, std::min(enough, bytesOfCache(3) / (2 * native::mostThreads())));
}

std::optional<TileChoice> chooseTiles(const TileProblem& problem) {
  std::int64_t elements = 1;
  std::vector<std::size_t> dimensions;  // slowest first
  for (std::size_t d = problem.extent.size(); d-- > 0;) {
    elements *= problem.extent[d];
    if (problem.extent[d] > 1) dimensions.push_back(d);
  }
  if (elements == 0 || problem.bytes == 0 || problem.cache == 0) return std::nullopt;
  if (elements > std::numeric_limits<std::int64_t>::max() / problem.bytes) return std::nullopt;
  if (elements * problem.bytes <= problem.cache * problem.threads) return std::nullopt;
  std::optional<TileChoice> best;
  // The fewest axes that save much: rows in one piece are computed faster than parts of them.
  constexpr double enough = 2;
  for (std::size_t count = 1; count <= std::min<std::size_t>(dimensions.size(), 3); ++count) {
    std::optional<TileChoice> choice = choiceAlong(problem, dimensions, count);
    if (choice && (!best || choice->gain > 1.2 * best->gain)) best = std::move(choice);
    if (best && best->gain >= enough) break;
  }
  return best && best->gain >= leastGain ? best : std::nullopt;
}

}  // namespace sk::native
