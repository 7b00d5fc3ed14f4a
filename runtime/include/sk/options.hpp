// SPDX-License-Identifier: MIT
//
// The dials of accuracy (docs/accuracy.md) and of speed (docs/performance.md): what a call, a kernel's declaration, a
// configuration file or a stream may choose.
#pragma once

#include <cstdint>

namespace sk {

/// What a stream holds the floats of its elements as. Kernels read and write floats all the same, rounded to nearest;
/// those in extended or double precision get and give all bits of doubles.
enum class Storage : std::uint8_t {
  Default,  ///< what the device's configuration says of the stream's name, else Single
  Single,  ///< floats
  Half,  ///< halves: half the memory, 11 bits
  Extended,  ///< doubles, of which pairs of floats use 48 bits
  Double,  ///< doubles
};

/// How a reduce adds floats, of which n are summed and S is the sum of their magnitudes; u = 2^-24.
enum class Accumulate : std::uint8_t {
  Default,  ///< Compensated, where the reduce has a sum of floats and the device room for it
  Tree,  ///< plain additions in a tree: the error is some u S log n
  Compensated,  ///< with what each addition loses summed beside it: u times the result and (log n)^2 u^2 S
  Extended,  ///< all of the reduce in pairs of floats, or, on a software renderer, in doubles: u times the result
  ///< and 2^-44 S log n
  Exact,  ///< the sum itself, rounded once: the same bits in every order, on every device
};

/// What a kernel's floats are computed in; its arguments stay what they are.
enum class Precision : std::uint8_t {
  Default,  ///< what the kernel is declared with, which is Single where it says nothing
  Half,  ///< every result rounded to 11 bits, in the range of half
  Single,  ///< floats: 24 bits
  Extended,  ///< pairs of floats: 44 to 48 bits, in the range of float
  Double,  ///< the device's own doubles: 53 bits
};

/// Which functions compute exp, sin, pow and the like.
enum class Intrinsics : std::uint8_t {
  Default,  ///< Accurate
  Fast,  ///< the device's own, with the errors and special cases that it has
  Accurate,  ///< within 3 ulp and with the special cases of C, by code of ours where the device's own are not
};

/// Whether functions that are declared with a table of their values, [[table(lo, hi, n, linear)]], are looked up there.
/// Other precisions than float's compute them, whatever is chosen.
enum class Tables : std::uint8_t {
  Default,  ///< On
  Off,  ///< they are computed
  On,  ///< with the error that Device::tables() tells
};

/// Whether native code may fuse a product with the sum that it feeds, as in `a * b + c`: one operation, which rounds once.
/// GLSL leaves that to the driver, so that GL devices ignore the choice.
enum class Contraction : std::uint8_t {
  Default,  ///< what the kernel is declared with, which is Exact where it says nothing
  Exact,  ///< every operation is rounded, in the order of the text: the same bits on every CPU
  Fast,  ///< they are fused where the CPU has the operation; compensated and exact sums stay as they are
};

/// What programs of a kernel are run as. Results are the same, but for the order in which a reduce adds.
enum class Target : std::uint8_t {
  Default,  ///< what is faster on the device
  Fragment,  ///< drawn, as every GL and ES device can
  Compute,  ///< dispatched, by OpenGL 4.3
  Native,  ///< compiled for the CPU; native devices alone run it
};

/// What a call may choose, by `sum.with({.accumulate = ...})(x)`.
struct CallOptions {
  Accumulate accumulate = Accumulate::Default;
  Precision precision = Precision::Default;
  Intrinsics intrinsics = Intrinsics::Default;
  Tables tables = Tables::Default;
  Target target = Target::Default;
  Contraction contraction = Contraction::Default;

  bool operator==(const CallOptions&) const = default;

  /// These, with what `later` chooses in their place: all of it that is not Default.
  constexpr CallOptions with(const CallOptions& later) const {
    const auto chosen = [](auto first, auto second) {
      return second == decltype(second)::Default ? first : second;
    };
    return {.accumulate = chosen(accumulate, later.accumulate),
            .precision = chosen(precision, later.precision),
            .intrinsics = chosen(intrinsics, later.intrinsics),
            .tables = chosen(tables, later.tables),
            .target = chosen(target, later.target),
            .contraction = chosen(contraction, later.contraction)};
  }
};

}  // namespace sk
