// SPDX-License-Identifier: MIT
//
// Options for accuracy (docs/accuracy.md) and speed (docs/performance.md) that a call, a kernel's
// declaration, a configuration file or a stream may choose.
#pragma once

#include <cstdint>
#include <optional>

#include "sk/shape.hpp"

namespace sk {

/// The box of a domain from `begin` (inclusive) to `end` (exclusive), rows first. The default stands for the whole domain.
struct Box {
  Index begin = {}, end = {};

  constexpr bool isWhole() const { return begin.rank() == 0 && end.rank() == 0; }
  bool operator==(const Box&) const = default;
};

class DeviceState;  // the runtime's own

/// A domain that a call is given, because it follows from no stream: WithOptions::over() (sk/call.hpp).
struct GivenDomain {
  Shape shape = {};
  DeviceState* device = nullptr;  ///< null: the device of the call's streams

  bool operator==(const GivenDomain&) const = default;
};

/// How a stream stores the floats of its elements. Kernels still read and write floats, rounded to nearest;
/// kernels in extended or double precision read and write all bits of doubles.
enum class Storage : std::uint8_t {
  Default,  ///< the configuration's choice for the stream's name, else Single
  Single,  ///< floats
  Half,  ///< halves: half the memory, 11 bits of precision
  Extended,  ///< doubles, of which pairs of floats use 48 bits
  Double,  ///< doubles
};

/// How a reduction adds floats: S is the sum of their magnitudes, d the depth of the tree (docs/accuracy.md, Sums), u = 2^-24.
enum class Accumulate : std::uint8_t {
  Default,  ///< Compensated, if the reduction sums floats and the device has room for it
  Tree,  ///< plain additions in a tree: the error is at most d u S
  Compensated,  ///< sums rounding errors, too: the error is at most u times the result plus 2 (d + 1)^2 u^2 S
  /// The whole reduction in pairs of floats, or in doubles on a software renderer: the error is at most u times the
  /// result plus (d + 1) 2^-44 S.
  Extended,
  Exact,  ///< the exact sum, rounded once: the same bits in every order, on every device
};

/// What a kernel computes floats in; the types of its arguments do not change.
enum class Precision : std::uint8_t {
  Default,  ///< the precision of the kernel's declaration, else Single
  Half,  ///< every result is rounded to 11 bits and has the range of half
  Single,  ///< floats: 24 bits
  Extended,  ///< pairs of floats: 44 to 48 bits, in the range of float
  Double,  ///< the device's own doubles: 53 bits
};

/// Which implementations of exp, sin, pow and similar functions are used.
enum class Intrinsics : std::uint8_t {
  Default,  ///< Accurate
  Fast,  ///< the device's own, with their errors and special cases
  Accurate,  ///< within 3 ulp and with C's special cases; replaces the device's own if these are not
};

/// Whether functions declared with a table, [[table(lo, hi, n, linear)]], are looked up in it. Precisions
/// other than float always compute them.
enum class Tables : std::uint8_t {
  Default,  ///< On
  Off,  ///< computes them
  On,  ///< looks them up, with the error that Device::tables() reports
};

/// Whether a compiler may fuse a product with the sum that uses it, as in `a * b + c`, into one operation that rounds once.
/// On GL devices it may also combine and cancel operations, as GLSL allows.
enum class Contraction : std::uint8_t {
  Default,  ///< the choice of the kernel's declaration, else Exact
  Exact,  ///< rounds every operation of a kernel, in the order of the text: the same bits on every CPU
  Fast,  ///< fuses if the CPU has the operation; GL devices do as they like; compensated and exact sums do not change
};

/// How a kernel is executed. Results are the same, except for the order in which a reduction adds.
enum class Target : std::uint8_t {
  Default,  ///< whichever is faster on the device
  Fragment,  ///< drawn; every GL and ES device can do it
  Compute,  ///< dispatched; needs OpenGL 4.3 or ES 3.1
  Native,  ///< compiled for the CPU; only on native devices
};

/// Which elements a scan folds to an element of its result.
enum class Scan : std::uint8_t {
  Default,  ///< Inclusive
  Inclusive,  ///< all up to and including the one at the same place
  Exclusive,  ///< those before it; the first element of the result is the identity
};

/// Whether what elements push, and what they add to elements of a scatter output, keeps its order.
enum class Order : std::uint8_t {
  Default,  ///< the choice of the kernel's declaration, else Kept
  Kept,  ///< the result is that of a loop over the elements in row-major order: the same bits in every run
  /// The device may take values as they come, which can be faster. Variable outputs hold the same values in another
  /// order, sums of floats round differently, and any one of several values stored to an element wins: results may
  /// differ from run to run. Kernels without such outputs, and reductions, ignore the choice.
  Any,
};

/// Options of one call, as in `sum.with({.accumulate = ...})(x)`.
struct CallOptions {
  Accumulate accumulate = Accumulate::Default;
  Precision precision = Precision::Default;
  Intrinsics intrinsics = Intrinsics::Default;
  Tables tables = Tables::Default;
  Target target = Target::Default;
  Contraction contraction = Contraction::Default;
  Order order = Order::Default;
  Scan scan = Scan::Default;  ///< scans only
  /// Scans only: scans each line along this dimension by itself (0 is the slowest); by default, the whole stream
  /// in row-major order.
  std::optional<int> along = std::nullopt;
  /// Runs a kernel for the elements of this box of its domain only, or folds only these. The kernel sees the whole streams:
  /// indexof, extentof, boundary modes and gathers are what they are without a box. All other elements of the outputs keep
  /// their values.
  Box box = {};
  std::optional<GivenDomain> over = std::nullopt;  ///< the domain, if WithOptions::over() gives it

  bool operator==(const CallOptions&) const = default;

  /// Returns these options, overridden by every option of `later` that is not Default.
  constexpr CallOptions with(const CallOptions& later) const {
    const auto chosen = [](auto first, auto second) {
      return second == decltype(second)::Default ? first : second;
    };
    return {.accumulate = chosen(accumulate, later.accumulate),
            .precision = chosen(precision, later.precision),
            .intrinsics = chosen(intrinsics, later.intrinsics),
            .tables = chosen(tables, later.tables),
            .target = chosen(target, later.target),
            .contraction = chosen(contraction, later.contraction),
            .order = chosen(order, later.order),
            .scan = chosen(scan, later.scan),
            .along = later.along ? later.along : along,
            .box = later.box.isWhole() ? box : later.box,
            .over = later.over ? later.over : over};
  }
};

}  // namespace sk
