// SPDX-License-Identifier: MIT
//
// widen-floats: gives each kernel and reduce of floats a wide form, which computes in doubles, the device's own or
// pairs of floats, whatever it says float. Its streams still hold floats.
//
//   before   kernel void blend(float t, float a<>, float b[], out float r<>) { r = a + t * b[0]; }
//   after    the same, with the wide form
//            kernel void blend(float t, double a<> held as float, double b[] held as float,
//                              out double r<> held as float) {
//              double t_wide = double(t);
//              r = a + t_wide * b[0];
//            }
//
// Literals keep their value as floats, so that a form differs from another by its arithmetic alone. What scatters or
// pushes has its values rounded to floats where it does. A reduce's accumulators are doubles between its passes, and a
// kernel `finish` rounds them to floats at the end. What doubles cannot do yet, as matrices, has no wide form, and the
// kernel knows why.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void widenFloats(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
