// SPDX-License-Identifier: MIT
//
// The transform that plans passes for kernels that exceed the limits of a profile. If four planes can be
// written,
//
//   kernel void f(float x<>, out float a<>, ..., out float e<>) {
//     float t = costly(x);
//     a = t; ... e = t * t;
//   }
//
// becomes two passes: pass 1 computes t and writes it, a, b and c; pass 2 reads t and writes d and e. Each
// pass is a kernel of its own; the whole kernel stays for devices that can run it.
#pragma once

#include <span>

#include "ir/ir.hpp"

namespace skc::split {

/// Adds plans to the kernels that exceed some of `limits`, and the kernels of their passes to the module.
/// Skips reduces and kernels that push or scatter. Runs after specialize-gathers.
void splitKernels(ir::Module& module, std::span<const ir::Limits> limits);

}  // namespace skc::split
