// SPDX-License-Identifier: MIT
//
// Removes `continue` and `break` from an iteration of a loop that is being unrolled, and has no loop around
// it any more: a certain jump cuts the iteration off, and the rest after a possible one becomes the other
// branch of its `if`.
//
//   before   if (-1 == 0) continue;  if (x > 1.0) { r += 1.0; continue; }  r = 0.0;
//   after    if (x > 1.0) { r += 1.0; } else { r = 0.0; }
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc {

enum class IterationEnd : std::uint8_t {
  Completes,  ///< the next iteration follows
  LeavesLoop,  ///< this is the last iteration
  Unknown,  ///< depends on the elements: do not use the iteration
};

/// Removes the jumps of the surrounding loop from the block of one iteration.
IterationEnd removeJumps(const ir::Module& module, ir::Block& iteration);

}  // namespace skc
