// SPDX-License-Identifier: MIT
//
// sum-exactly: gives each scalar of a reduce's accumulators that is a sum of floats a variant that adds
// without rounding, to an integer with a position for every bit of every float (a superaccumulator: Kulisch,
// Computer Arithmetic and Validity, 2008). The order of summands does not change the sum, which is rounded
// once.
//
//   before   reduce void dot(float x<>, float y<>, reduce float total<>) { total += x * y; }
//   after    the same, exactly by
//            reduce void dot_exact(float x<>, float y<>, reduce int4 digits_0<> = 0, ..., reduce int flags<> = 0) {
//              digits_0 += exactProductDigits(x, y, 0); ...  flags |= exactProductFlags(x, y);
//            }
//            kernel void dot_finish(float total<>, int4 digits_0<>, ..., int flags<>, out float r_total<>) {
//              r_total = exactRounded(digits_0, ..., flags, base);
//            }
//   and, once per file, the reduce that combines digits.
//
// The digits of a product of two floats are exact, and take twice as many positions; other summands
// (sum_terms.hpp) are rounded to float first. Digits have room for the terms of a run whose elements add one each
// (sk/exact_digits.hpp); an element that may add more settles its digits. All arithmetic is on integers, on which all
// devices agree.
//
// Native code does not fold digits: the runtime adds terms to an accumulator of its own. ExactSum::term
// (exact_term.hpp) describes the terms.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void sumExactly(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
