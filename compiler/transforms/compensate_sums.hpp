// SPDX-License-Identifier: MIT
//
// compensate-sums: gives each reduce that sums floats a variant that also sums the rounding errors of the
// first sum.
//
//   before   reduce void squares(float x<>, reduce float total<> = 0) { total += x * x; }
//   after    the same, compensated by
//            reduce void squares(float x<>, reduce float total<> = 0, reduce float total_lost<> = 0) {
//              float term = roundedProduct(x, x);
//              total_lost += sumError(total, term) + productError(x, x);
//              total = roundedSum(total, term);
//            }
//            reduce void squares_combine(float total_part<>, reduce float total<>, float total_lost_part<>, reduce float
//                                        total_lost<>) {
//              total_lost += total_lost_part;
//              total_lost += sumError(total, total_part);
//              total = roundedSum(total, total_part);
//            }
//            kernel void squares_finish(float total<>, float total_lost<>, out float r_total<>) {
//              r_total = isfinite(total_lost) ? total + total_lost : total;
//            }
//
// sumError is the error of a float addition, itself a float, and productError the error of a multiplication
// (Dekker, Numer. Math. 18, 1971). A sum of n terms (sum_terms.hpp) then has one rounding of its own and an
// error of 2 (d + 1)^2 u^2 times the sum of magnitudes, in a tree of depth d: Sum2 and Dot2 of Ogita, Rump and Oishi (SIAM J.
// Sci. Comput. 26, 2005) over a tree. float_sums.hpp defines which accumulators and members are such sums;
// all others are folded and combined as before, possibly by the author's own reduce. A reduce without
// identities has no variant. If an element adds only one input or the product of two, a double holds that
// term, and native code sums in doubles.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void compensateSums(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
