// SPDX-License-Identifier: MIT
//
// compensate-sums: gives each reduce that sums floats a second form, which also sums what the first sum's
// roundings lose.
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
// sumError is the error of a float addition, itself a float, and productError that of a multiplication (Dekker, Numer.
// Math. 18, 1971), so that a sum of n terms (sum_terms.hpp) has one rounding of its own and some (log n)^2 u^2 of the
// sum of magnitudes: Sum2 and Dot2 of Ogita, Rump and Oishi (SIAM J. Sci. Comput. 26, 2005) over a tree. Which
// accumulators and members are such sums, float_sums.hpp says; all others are folded and combined as before, be it by the
// author's own reduce. A reduce that has no identities has no second form. Where an element adds no more than one input or the
// product of two, doubles hold that, and native code sums in them instead.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void compensateSums(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
