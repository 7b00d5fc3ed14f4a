// SPDX-License-Identifier: MIT
//
// The programs of dispatched scans, whose invocations fold runs of items and store a result for each item. In a tile,
// the invocations of a work group fold consecutive runs of a line:
//
//   total = the fold of the run's items (of the first run: from the result of the tiles before)
//   shared[i] = the fold of the totals 0 to i
//   for each item of the run: shared[i - 1] = fold(shared[i - 1], item), which is its result
//
// Results go through shared memory, so that neighbouring invocations store neighbouring texels.
#pragma once

#include <cstdint>
#include <string>

#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

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

/// The program of a pass whose unit is Run or Tile (scanProgram()). A pass that folds tiles computes one texel in each
/// work group; any other stores its results by itself.
std::string scanTileProgram(const Profile& profile, const program::Reduction& reduction,
                            const ReduceVariant& variant);

}  // namespace sk::assemble
