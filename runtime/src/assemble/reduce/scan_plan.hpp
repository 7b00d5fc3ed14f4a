// SPDX-License-Identifier: MIT
//
// The passes of a scan, as a pure schedule. To run it:
//
//   level 0 = the inputs' planes
//   for each pass of `folds`: level k + 1 = new planes of the accumulators' types and of pass.texture's shape;
//                             draw it from level k
//   for each pass of `scans`: target = pass.toResult ? the results' planes : new planes of pass.texture's shape;
//                             draw it from the last level, and from the target of the pass before, if
//                             pass.variant.carried; forget that level
//
// Result r of the runs of line l has number r * lines + l in a linearised texture. Where passes are dispatches, a work
// group folds a tile, which takes the place of the run, and an invocation stores all results of its run
// (ScanUnit): elements are read twice and results written once.
//
// Also how dispatched scans are divided into tiles, and which reductions can be (scan_tile_program.hpp).
//
// Checks planned passes that fold the terms of exact sums: no invocation may add more to digits than these have room for
// (sk/exact_digits.hpp). The planners assert it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/region_layout.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// The elements of a run (ReduceLimits::fanIn). An item of a level folds half a run on average, and the results of runs
/// take passes of their own.
inline constexpr std::int32_t scanRun = 16;
/// A run of an exact sum may continue from another one (sk/exact_digits.hpp), also in browsers.
static_assert(program::DigitLoad<std::int32_t>(scanRun).room() >= scanRun);

struct ScanPlan {
  std::vector<ReducePass> folds;  ///< from the elements to one run in each line
  std::vector<ReducePass> scans;  ///< one more; the last writes the results
};

/// The lines of elements that are scanned each by itself.
struct Lines {
  std::int32_t length;  ///< elements in each
  std::int32_t inner;  ///< the distance of its elements, in row-major numbers
};
/// The lines along the dimension in which there is one block. If there is one block in every dimension, all elements
/// are one line.
Lines linesOf(const Index4& extent, const Index4& blocks);

/// How the elements are addressed.
struct ScanAccess {
  bool byIndex = true;  ///< Walk::Index; only the extent of the elements' region layout matters then
  bool byTexel = false;  ///< elements and results are packed, and lines consist of whole texels
  /// The most items of a run in a tile of elements, and of results of runs; 0: they are not folded in tiles, which only
  /// dispatches can.
  std::int32_t elementRun = 0, partialRun = 0;
  bool chained = false;  ///< one pass scans all tiles of the elements, if they are one line
  bool ofDigits = false;  ///< folds the terms of an exact sum (sk/exact_digits.hpp)
  std::int32_t patience =
      1024;  ///< how often a group looks for the result of a tile before it folds it itself
};
/// Chooses tiles for a reduction. `chains`: the device scans them in one pass, if it can.
void addTiles(ScanAccess& access, const program::Reduction& reduction, bool chains);
/// Whether the elements of a region, which have no index, can be scanned by their numbers: they are consecutive in a
/// linearised stream, or in the rows of a plane.
bool isConsecutive(const RegionLayout& elements);

/// Plans the scan of `elements` to `result`, which has the same extent. It is not empty. `limits.grouped`: the passes
/// are dispatches.
ScanPlan planScan(const RegionLayout& elements, const RegionLayout& result, const ReduceLimits& limits,
                  const Lines& lines, const ScanAccess& access, bool isExclusive);

/// The invocations of the work groups. Each computes a run, of consecutive runs.
inline constexpr std::int32_t tileGroup = 256;
/// Groups are dispatched in rows of this many: group g is at (g % groupsPerRow, g / groupsPerRow).
inline constexpr int groupRowShift = 15;

/// The most items of a run in a tile of this reduction, a power of two; 0 if shared memory cannot hold its accumulators.
/// `packed`: an item is a texel of four elements.
std::int32_t longestRunInTile(const program::Reduction& reduction, bool packed);

/// Whether a program that folds elements can also combine its results.
bool combinesInFold(const program::Reduction& reduction);

/// Whether one pass may scan a line (ReduceVariant::chained): tiles find the result of those before in an order that
/// depends on time, so that accumulators must be integers, whose results do not depend on it.
bool mayChain(const program::Reduction& reduction);

/// Whether the digits have room for what the passes of a reduction fold, if each element adds one term.
bool keepsRoom(std::span<const ReducePass> passes);
/// The same for a scan.
bool keepsRoom(const ScanPlan& plan);

}  // namespace sk::assemble
