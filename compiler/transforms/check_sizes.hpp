// SPDX-License-Identifier: MIT
//
// Reports kernels that become too large when every call in them is replaced by the function's body, as native code and OpenGL
// drivers do:
//
//   float f1(float x) { return f0(x) + f0(x); }  ...  float f30(float x) { return f29(x) + f29(x); }   // 2^30 times f0
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void checkSizes(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
