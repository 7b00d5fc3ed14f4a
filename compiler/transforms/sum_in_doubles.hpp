// SPDX-License-Identifier: MIT
//
// sum-in-doubles: gives kernels that sum floats beside their outputs a native variant whose sums are doubles. It costs
// a fraction of a compensated sum, and is more exact.
//
//   before   kernel void step(float q<>, float r<>, out float s<>, reduce float ss<> = 0) { s = r - q; ss += s * s; }
//   after    the same, natively folded by
//            kernel void step(float q<>, float r<>, out float s<>, reduce double ss<> = 0) {
//              s = r - q;
//              ss += double(s) * double(s);
//            }
//            reduce void step_combine(double ss_part<>, reduce double ss<>) { ss += ss_part; }
//            kernel void step_finish(double ss<>, out float r_ss<>) { r_ss = float(ss); }
//
// A double holds each term (sum_terms.hpp), a float or the product of two. All else is computed in floats: the outputs
// keep their bits. A kernel with sums in members of accumulators, or that folds more into a sum, has no such variant.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

/// Sets FoldParts::inDoubles.
void sumInDoubles(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
