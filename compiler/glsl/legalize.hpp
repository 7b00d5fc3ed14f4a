// SPDX-License-Identifier: MIT
//
// Rewrites operations that a target leaves undefined for some operands, so that the printer finds only what the target defines.
// It runs on the copy of a module that becomes GLSL; native code defines every operation itself.
//
//   before   r = a[i] << n;
//   after    r = a[clamp(i, 0, 4)] << (n & 31);
#pragma once

#include "ir/ir.hpp"

namespace skc::emit {

/// What a target's language defines as the IR does.
struct Capabilities {
  bool shiftsByAnyCount;  ///< by the count modulo 32
  /// Takes the nearest element for an index outside of an array, vector or matrix, and reads an index where it stands. Mesa (22.3,
  /// llvmpipe) reads it only when it loads or stores, from the register that it gave to a loop's variable, and may have
  /// incremented that register by then: `a[i] = a[i + 1]` stores to a[i + 1]. A computed index has a register of its own.
  bool clampsIndices;
};

/// The common subset of GLSL 3.30 and ESSL 3.00.
inline constexpr Capabilities glslCapabilities = {.shiftsByAnyCount = false, .clampsIndices = false};

/// Rewrites the functions of a module, its constants, and those of its kernels' parameters.
void legalize(ir::Module& module, const Capabilities& target);

/// The same for one expression that is no lvalue.
void legalize(const ir::Module& module, const Capabilities& target, ir::ExprPtr& expr);

}  // namespace skc::emit
