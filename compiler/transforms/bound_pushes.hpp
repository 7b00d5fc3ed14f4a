// SPDX-License-Identifier: MIT
//
// bound-pushes: determines the operation of each scatter output, and how many elements one element of the
// domain pushes or scatters at most, so that small bounds need no readback.
//
//   kernel void split(float x<>, vout float r<>) {   // r: at most 2
//     push(r, x);
//     if (x > 0) push(r, -x);
//   }
//
// A branch counts as the larger of its sides, a loop with a known trip count as that many times its body, any
// other loop as unknown. A scatter output with two kinds of operation is an error, because the device does
// one kind per pass.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void boundPushes(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
