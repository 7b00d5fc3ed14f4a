// SPDX-License-Identifier: MIT
//
// Rewrites operations that a target lacks, or leaves undefined for some operands, so that the printer finds only what the target
// has. It runs on the copy of a module that becomes GLSL; native code defines every operation itself.
//
//   before   r = a[i] << n;                             r /= int(x);
//   after    r = a[clamp(i, 0, 4)] << (n & 31);         r = sk_div(r, sk_int(x));
#pragma once

#include "glsl/polyfills.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// What a target's language defines as the IR does.
struct Capabilities {
  bool shiftsByAnyCount = false;  ///< by the count modulo 32
  /// Takes the nearest element for an index outside of an array, vector or matrix, and reads an index where it stands. Mesa (22.3,
  /// llvmpipe) reads it only when it loads or stores, from the register that it gave to a loop's variable, and may have
  /// incremented that register by then: `a[i] = a[i + 1]` stores to a[i + 1]. A computed index has a register of its own.
  bool clampsIndices = false;
  bool dividesIntegers = false;  ///< by 0 and -1, too; a remainder has the sign of the dividend
  bool convertsAnyFloat = false;  ///< to the nearest int or uint, NaN to 0
  bool hasNarrowTypes = false;
  bool hasIntrinsics = false;  ///< all of intrinsics.def, for scalars as for vectors
  bool hasWideTypes = false;  ///< double, long and ulong, with their operators
  bool choosesByComponent = false;  ///< &&, || and ?: of vectors other than floats, and v[i]
  bool comparesWithZero =
      false;  ///< every driver compares rounded floats and magnitudes of ints with 0 as written
  bool prints = false;
  bool hasRowsFirst =
      false;  ///< a matrix is a list of rows, and the matrix on the left of a vector multiplies it
};

/// The common subset of GLSL 3.30 and ESSL 3.00.
inline constexpr Capabilities glslCapabilities;

/// Rewrites the functions of a module, its constants, and those of its kernels' parameters. Adds the functions that they call.
Polyfills legalize(ir::Module& module, const Capabilities& target);

/// The same for one expression that is no lvalue.
void legalize(const ir::Module& module, const Capabilities& target, Polyfills& polyfills, ir::ExprPtr& expr);

}  // namespace skc::emit
