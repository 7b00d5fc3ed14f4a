// SPDX-License-Identifier: MIT
//
// How dispatched scans are divided into tiles, and which reductions can be (scan_tile_program.hpp).
#pragma once

#include <cstdint>

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

}  // namespace sk::assemble
