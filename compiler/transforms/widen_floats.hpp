// SPDX-License-Identifier: MIT
//
// widen-floats: gives each kernel and reduce of floats a wide variant, which computes in double (the device's
// own, or pairs of floats) wherever the kernel says float. Its streams still hold floats.
//
//   before   kernel void blend(float t, float a<>, float b[], out float r<>) { r = a + t * b[0]; }
//   after    the same, with the wide variant
//            kernel void blend(float t, double a<> held as float, double b[] held as float,
//                              out double r<> held as float) {
//              double t_wide = double(t);
//              r = a + t_wide * b[0];
//            }
//
// Literals get the value of their text, which wideValue() reads. Values that are scattered or pushed are
// rounded to float there. A reduce's accumulators are doubles between its passes, and
// a kernel `finish` rounds them to float at the end. A kernel that uses what doubles do not support, such as
// matrices, has no wide variant, and records why.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void widenFloats(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
