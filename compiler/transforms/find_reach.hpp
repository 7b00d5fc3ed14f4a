// SPDX-License-Identifier: MIT
//
// find-reach: notes beside each gather of a declared kernel how far from its own element the kernel reads it.
//
//   kernel void blur(float u[], out float r<>) {   // u: x 1 before, 2 after
//     int x = indexof(r).x;
//     r = u[x - 1] + u[x + 2];
//   }
//
// Where that is not known, the author's promise counts: [[halo(2)]]. A promise that is known to be broken is an error.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void findReach(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
