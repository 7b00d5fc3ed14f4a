// SPDX-License-Identifier: MIT
//
// Coalesces dimensions, so that native loops have fewer and longer rows: dimensions that are contiguous in
// all streams of a call become one, if the kernel uses no indices or extents. This changes how elements
// are counted, never their order in a block. Blocks that are long lines across short rows become rows, whose pieces
// go to different threads.
#pragma once

#include <span>

#include "native/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// Changes `domain`, `block` and the operands of the kernel's parameters alike. `block` is that of a
/// reduction; for a kernel, it is the whole domain. In a scan, accumulators have the shape of the domain.
void coalesce(const program::Kernel& kernel, std::span<native::Operand> operands, native::Extents& domain,
              native::Extents& block, bool isScan = false);

}  // namespace sk
