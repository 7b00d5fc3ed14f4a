// SPDX-License-Identifier: MIT
//
// round-halves: gives each kernel and reduce of floats a variant that computes in half precision: every float
// that is read or computed is rounded to the nearest half.
//
//   before   kernel void blend(float t, float a<>, float b[], out float r<>) { r = a + t * b[0]; }
//   after    the same, with the variant
//            kernel void blend(float t, float a<>, float b[], out float r<>) {
//              float t_half = half(t), a_half = half(a);
//              r = half(a_half + half(t_half * half(b[0])));
//            }
//
// Literals are rounded from their text, and constants computed in halves.
//
// Float has at least two more bits than twice those of half, so + - * / and sqrt give the results of IEEE
// 754's binary16 (Figueroa, When is double rounding innocuous?, 1995); other functions are rounded once more.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void roundHalves(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
