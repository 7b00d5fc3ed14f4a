// SPDX-License-Identifier: MIT
//
// Replaces intrinsics by calls of the library's functions:
//
//   before   kernel void wave(float2 x<>, out float2 r<>) { r = sin(x); }
//   after    float2 sin_2(float2 a) { return float2(sin(a.x), sin(a.y)); }
//            kernel void wave(float2 x<>, out float2 r<>) { r = sin_2(x); }
#pragma once

#include "ir/ir.hpp"
#include "native/library/link_library.hpp"

namespace skc::native {

/// Each kernel gets its own copies of the functions, as after specialize-gathers.
void callLibrary(ir::Module& module, const LinkedFunctions& linked);

}  // namespace skc::native
