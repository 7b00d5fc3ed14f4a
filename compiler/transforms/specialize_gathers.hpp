// SPDX-License-Identifier: MIT
//
// specialize-gathers: copies each function for each kernel and each choice of streams that it is called with,
// because GLSL functions cannot take streams.
//
//   before   float sum3(float a[], int i) { return a[i - 1] + a[i] + a[i + 1]; }
//            kernel void f(float u[], float v[], out float r<>) { r = sum3(u, 7) + sum3(v, 7); }
//   after    float sum3_u(int i) { return $0[i - 1] + $0[i] + $0[i + 1]; }
//            float sum3_v(int i) { return $1[i - 1] + $1[i] + $1[i + 1]; }
//            void f(out float r) { r = sum3_u(7) + sum3_v(7); }
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

/// Afterwards every StreamRef names a parameter of the kernel or its domain, only entries have stream
/// parameters, each function belongs to one kernel, and callees precede their callers. An element parameter
/// whose argument is not an element has the domain's index.
void specializeGathers(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
