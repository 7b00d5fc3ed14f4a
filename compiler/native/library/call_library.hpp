// SPDX-License-Identifier: MIT
//
// Calls of the library's functions in place of intrinsics:
//
//   before   kernel void wave(float2 x<>, out float2 r<>) { r = sin(x); }
//   after    float2 sin_2(float2 a) { return float2(sin(a.x), sin(a.y)); }
//            kernel void wave(float2 x<>, out float2 r<>) { r = sin_2(x); }
#pragma once

#include "ir/ir.hpp"
#include "native/library/link_library.hpp"

namespace skc::native {

/// Each kernel gets copies of the functions of its own, as after specialize-gathers.
void callLibrary(ir::Module& module, const LinkedFunctions& linked);

}  // namespace skc::native
