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

#include <string>

#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// The program of a pass whose unit is Run or Tile (scanProgram()). A pass that folds tiles computes one texel in each
/// work group; any other stores its results by itself.
std::string scanTileProgram(const Profile& profile, const program::Reduction& reduction,
                            const ReduceVariant& variant);

}  // namespace sk::assemble
