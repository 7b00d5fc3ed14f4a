// SPDX-License-Identifier: MIT
//
// Warns of outputs that some path through a kernel leaves unwritten or reads before writing. It changes
// nothing.
//
//   kernel void f(float x<>, out float2 v<>) {   // warning: output 'v' is not written on every path
//     v.x = x;
//     if (x > 0) v.y = 1;
//   }
//
// Components and members are tracked one by one. A loop counts as entered if its first test is known to
// succeed; a write at an unknown index counts as a write of the whole array or vector. A function that never
// returns would hang the device, and is an error.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void checkOutputs(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
