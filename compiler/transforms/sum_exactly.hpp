// SPDX-License-Identifier: MIT
//
// sum-exactly: gives each scalar of a reduce's accumulators that is a sum of floats a form which adds without any rounding:
// to an integer that has a place for every bit of every float (a superaccumulator: Kulisch, Computer
// Arithmetic and Validity, 2008), so that no order of summands gives another sum, and rounds once.
//
//   before   reduce void dot(float x<>, float y<>, reduce float total<>) { total += x * y; }
//   after    the same, exactly by
//            reduce void dot_exact(float x<>, float y<>, reduce int4 digits_0<> = 0, ..., reduce int flags<> = 0) {
//              digits_0 += exactProductDigits(x, y, 0); ...  flags |= exactProductFlags(x, y);
//            }
//            kernel void dot_finish(float total<>, int4 digits_0<>, ..., int flags<>, out float r_total<>) {
//              r_total = exactRounded(digits_0, ..., flags, base);
//            }
//   and, once for all of a file, the reduce that combines digits.
//
// The digits of a product of two floats are exact, and take twice as many places; what else is added (sum_terms.hpp) is
// rounded to a float first. A digit has room for 32 summands: an element that may bring more than one settles
// the digits before. Everything is integers, which all devices agree about.
//
// Native code does not fold digits: the runtime adds terms to an accumulator of its own. What these terms are is in
// ExactSum::term (exact_term.hpp).
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void sumExactly(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
