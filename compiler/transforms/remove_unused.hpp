// SPDX-License-Identifier: MIT
//
// remove-unused: takes out what no kernel needs: functions, constants, types, and locals that are
// never read, together with what is assigned to them. An expression has no effect, so it may go; a
// call that writes to other variables stays.
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
