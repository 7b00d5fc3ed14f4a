// SPDX-License-Identifier: MIT
//
// Gives kernels that fold beside their outputs parts, for targets that cannot do both in one pass.
//
//   before   kernel void step(float a, float q<>, float r<>, out float s<>, reduce float ss<> = 0) {
//              s = r - a * q;
//              ss += s * s;
//            }
//   after    the same, and
//            kernel void step(float a, float q<>, float r<>, out float s<>) { s = r - a * q; }
//            reduce void step(float s<>, reduce float ss<> = 0) { ss += s * s; }
//
// The kernel itself can be folded without its outputs. The reduce reads outputs instead of computing them once
// more; it exists if that costs less.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc::split {

/// Sets Kernel::parts. Reports outputs that depend on an accumulator.
void splitFolds(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc::split
