// SPDX-License-Identifier: MIT
//
// The transform that gives plans to kernels which exceed the limits of a profile. Where four planes can be
// written,
//
//   kernel void f(float x<>, out float a<>, ..., out float e<>) {
//     float t = costly(x);
//     a = t; ... e = t * t;
//   }
//
// becomes, in words: pass 1 computes t and writes it, a, b and c; pass 2 reads t and writes d and e.
// Each pass is a kernel of its own, and the whole one stays for devices that can run it.
#pragma once

#include <span>

#include "ir/ir.hpp"

namespace skc::split {

/// Adds plans to the kernels (no reduces, none that push or scatter) that exceed some of `limits`, and the kernels of their
/// passes to the module. Runs after specialize-gathers.
void splitKernels(ir::Module& module, std::span<const ir::Limits> limits);

}  // namespace skc::split
