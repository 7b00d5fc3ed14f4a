// SPDX-License-Identifier: MIT
//
// The properties of a device's float arithmetic that the runtime relies on. `sk info` measures many more.
#pragma once

#include <cstdint>

namespace sk {

/// Keeps a driver's compiler from simplifying float operations that compute rounding errors: it may replace
/// (a + b) - a by b.
enum class Barrier : std::uint8_t {
  None,  ///< no barrier
  Xor,  ///< the bits of each result are xored with a uniform that is 0
  Precise,  ///< GLSL's `precise`
};

struct Arithmetic {
  /// Whether the rounding errors of a sum and of a product of two floats can be computed exactly (TwoSum:
  /// Knuth, TAOCP 2, 4.2.2; TwoProd: Dekker, Numerische Mathematik 18, 1971). Compensated sums and pairs of
  /// floats need them.
  bool exactSums = true;
  /// The barrier that this requires. Native code needs none.
  Barrier barrier = Barrier::None;
  /// Whether the device computes a kernel's own operations as they are written even without a barrier, as a trial has shown in
  /// each kind of program.
  /// Contraction::Exact then needs none. Not tried, and false, where the barrier is `precise`, which costs nothing.
  bool asWritten = true;
};

}  // namespace sk
