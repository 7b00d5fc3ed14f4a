// SPDX-License-Identifier: MIT
//
// Warns of outputs that some path through a kernel leaves unwritten, or that are read first. It changes nothing.
//
//   kernel void f(float x<>, out float2 v<>) {   // warning: output 'v' is not written on every path
//     v.x = x;
//     if (x > 0) v.y = 1;
//   }
//
// Components and members are followed one by one. A loop counts as entered where its first test is
// known to hold; a write at an index that is not known counts as one of the whole array or vector.
// A function that no path leaves would hang the device: that is an error.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void checkOutputs(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
