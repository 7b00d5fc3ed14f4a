// SPDX-License-Identifier: MIT
//
// Finds `for` loops whose steps NVIDIA's drivers (580) execute once too often: a `return` in the body, or a `break` from a loop
// that the driver unrolls, skips the rest of the body, but not the step. A break keeps the counter of a loop that has no other step.
//
//   for (int i = 0; i < n; ++i, ++r) {       the element that returns at i = 2 gets r = 3
//     if (i == x) return;
//   }
//
// A step that only changes what the loop itself declares does no harm: nobody reads it after the jump.
#pragma once

#include "ir/ir.hpp"

namespace skc::emit {

/// True if the body may leave the loop and the step changes what can be read afterwards.
bool stepShowsAfterJump(const ir::Module& module, const ir::Loop& loop);

}  // namespace skc::emit
