// SPDX-License-Identifier: MIT
//
// remove-unused: removes functions, constants, types and locals that no kernel needs, and assignments to such
// locals. An expression has no side effect and may go; a call that writes to other variables stays.
//
//   before   float twice(float x) { return x + x; }
//            kernel void f(float x<>, out float r<>) { float a = exp(x); a += 1.0; r = x; }
//   after    kernel void f(float x<>, out float r<>) { r = x; }
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void removeUnused(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
