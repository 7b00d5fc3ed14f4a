// SPDX-License-Identifier: MIT
//
// What the runtime itself builds on of a device's float arithmetic. `sk info` measures much more.
#pragma once

#include <cstdint>

namespace sk {

/// What keeps a driver's compiler from simplifying float operations whose rounding errors are the point: it may take
/// (a + b) - a for b.
enum class Barrier : std::uint8_t {
  None,  ///< nothing does
  Xor,  ///< the bits of each result are combined with a uniform, which is 0
  Precise,  ///< GLSL's `precise`
};

struct Arithmetic {
  /// Whether a sum and a product of two floats can be had together with exactly what they lose by rounding (TwoSum:
  /// Knuth, TAOCP 2, 4.2.2; TwoProd: Dekker, Numerische Mathematik 18, 1971). Compensated sums and pairs of floats are
  /// made of these.
  bool exactSums = true;
  /// What it takes. Native code needs nothing.
  Barrier barrier = Barrier::None;
};

}  // namespace sk
