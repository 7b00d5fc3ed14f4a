// SPDX-License-Identifier: MIT
//
// The passes of this folder: transforms.cpp runs them among those of transforms/passes.hpp.
#pragma once

#include <span>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc::split {

/// split-folds: gives kernels that fold beside their outputs parts, for targets that cannot do both in one pass.
///
///   before   kernel void step(float a, float q<>, float r<>, out float s<>, reduce float ss<> = 0) {
///              s = r - a * q;
///              ss += s * s;
///            }
///   after    the same, and
///            kernel void step(float a, float q<>, float r<>, out float s<>) { s = r - a * q; }
///            reduce void step(float s<>, reduce float ss<> = 0) { ss += s * s; }
///
/// The kernel itself can be folded without its outputs. The reduce reads outputs instead of computing them once
/// more; it exists if that costs less.
///
/// Sets Kernel::parts. Reports outputs that depend on an accumulator.
void splitFolds(ir::Module& module, Diagnostics& diagnostics);

/// slice-assertions: leaves of each kernel that checks assertions only what their conditions need.
///
///   before   kernel f(float x<>, float y<>, out float r<>, out int failed<>) {
///              failed = 0;
///              if (failed == 0 && !(x >= 0)) failed = 1;
///              r = sqrt(x) + y;
///            }
///   after    kernel f(float x<>, out int failed<>) {
///              failed = 0;
///              if (failed == 0 && !(x >= 0)) failed = 1;
///            }
///
/// Sets AssertionCheck::operands. A scatter output whose extents count becomes a gather. Reports conditions that depend on an
/// accumulator.
void sliceAssertions(ir::Module& module, Diagnostics& diagnostics);

/// split-kernels: plans passes for kernels that exceed the limits of a profile. If four planes can be
/// written,
///
///   kernel void f(float x<>, out float a<>, ..., out float e<>) {
///     float t = costly(x);
///     a = t; ... e = t * t;
///   }
///
/// becomes two passes: pass 1 computes t and writes it, a, b and c; pass 2 reads t and writes d and e. Each
/// pass is a kernel of its own; the whole kernel stays for devices that can run it.
///
/// Adds plans to the kernels that exceed some of `limits`, and the kernels of their passes to the module.
/// Skips reduces and kernels that push or scatter. Runs after specialize-gathers.
void splitKernels(ir::Module& module, std::span<const ir::Limits> limits);

}  // namespace skc::split
