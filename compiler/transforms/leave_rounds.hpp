// SPDX-License-Identifier: MIT
//
// `continue` and `break` in a round of a loop that is being unrolled, which has no loop around it any more: what leaves the
// round for certain cuts it off, and the rest of a round becomes the other branch of an `if` that may skip it.
//
//   before   if (-1 == 0) continue;  if (x > 1.0) { r += 1.0; continue; }  r = 0.0;
//   after    if (x > 1.0) { r += 1.0; } else { r = 0.0; }
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc {

enum class RoundEnd : std::uint8_t {
  Completes,  ///< the next round follows
  LeavesLoop,  ///< this is the last round
  Unknown,  ///< the elements decide: the round is not to be used
};

/// Takes the jumps of the loop around it out of one round's block.
RoundEnd leaveRound(const ir::Module& module, ir::Block& round);

}  // namespace skc
