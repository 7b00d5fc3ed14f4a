// SPDX-License-Identifier: MIT
//
// Rejects kernels with more parameters or planes than their descriptors and the runtime's keys can number
// (sk/program.hpp, runtime/src/gl_device/program/variant.hpp), and warns of uniforms that exceed some
// devices' space. Rejects kernels that inlining makes too large. Kernels that exceed what a device can do in one pass are left to split-kernels.
#pragma once

#include <cstddef>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

/// What descriptors and keys number.
struct KernelSize {
  std::size_t parameters = 0;
  std::size_t reads = 0;  ///< streams that are read
  std::size_t planes = 0;  ///< of all streams
};
KernelSize sizeOf(const ir::Module& module, const ir::Kernel& kernel);

/// True if a kernel of this size can be described. Transforms ask before they add parameters to one.
bool fits(const KernelSize& size);

/// Checks the kernels as they are declared.
void checkLimits(const ir::Module& module, Diagnostics& diagnostics);

/// Checks the kernel that combines the results of a fold, which has two parameters for each accumulator. Returns false
/// after an error.
bool checkCombinationFits(const ir::Module& module, const ir::Kernel& kernel, Diagnostics& diagnostics);

/// Reports kernels that become too large when every call in them is replaced by the function's body, as native code and OpenGL
/// drivers do:
///
///   float f1(float x) { return f0(x) + f0(x); }  ...  float f30(float x) { return f29(x) + f29(x); }   // 2^30 times f0
void checkSizes(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
