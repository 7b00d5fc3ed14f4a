// SPDX-License-Identifier: MIT
//
// bound-pushes: finds what the statements of each scatter output do, and how many elements a single one of
// the domain pushes or scatters at most, so that no readback is needed where few of them are certain.
//
//   kernel void split(float x<>, vout float r<>) {   // r: at most 2
//     push(r, x);
//     if (x > 0) push(r, -x);
//   }
//
// Branches count as the larger of their sides, loops of a known number of rounds as so many times their body,
// all others as unknown. A scatter output that is written by two kinds of operation is an error here, since
// the device does one kind in a pass.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void boundPushes(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
