// SPDX-License-Identifier: MIT
//
// Collects, while expressions are printed, the functions that a body needs because GLSL 3.30 lacks them: each
// once, in the order of first use.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

class Polyfills {
 public:
  /// Adds the function of an intrinsic's row for this type of its first argument.
  void intrinsic(ir::Intrinsic intrinsic, ir::Type argument);
  /// && or || for two bool vectors; returns the function's name.
  std::string logical(ir::BinaryOp op, int width);
  /// Componentwise select between two vectors of int, uint or bool; returns the function's name.
  std::string select(ir::Type type);
  /// A component of a vector at an index that is computed, the nearest one to an index outside; returns the function's name.
  /// Chromium 156 with SwiftShader takes another component for `c ? u : vec2(v[i], 0)`.
  std::string component(ir::Type vector, ir::Type index);
  /// / or % of integers, defined for all operands; returns the function's name. GLSL's are undefined if the
  /// divisor is 0, the quotient is out of range, or, for %, an operand is negative.
  std::string quotient(ir::BinaryOp op, ir::Type lhs, ir::Type rhs);
  /// The magnitude of ints, as C++ has it, that of the lowest int being the lowest int; returns the function's name. NVIDIA
  /// (580) takes `abs(x) < 0` for false.
  std::string magnitude(ir::Type type);
  /// Whether a float is neither 0 nor -0; returns the function's name. NVIDIA (580) takes `bool(floor(x))` for false, and
  /// `floor(x) != 0.0`, too, where an `else` belongs to it; likewise with ceil.
  std::string nonzero();
  /// Converts reals to int or uint: truncated, clamped, NaN to 0; returns the function's name.
  std::string truncated(ir::Type to);
  /// An intrinsic that the assembler defines, for arguments of this width; returns the function's name.
  std::string defined(sk::program::Intrinsic intrinsic, int width);
  /// The same for one double.
  std::string definedOfDouble(sk::program::Intrinsic intrinsic);

  /// Converts from the arithmetic type to a narrow type; returns the function's name.
  std::string quantize(ir::Type type);

  /// Adds any other function, unless it has been added.
  void add(std::string function);

  /// The definitions of the functions added.
  const std::vector<std::string>& functions() const { return functions_; }
  /// The intrinsics that the assembler must define.
  const std::vector<sk::program::IntrinsicUse>& intrinsics() const { return intrinsics_; }

 private:
  sk::program::IntrinsicUse& use(sk::program::Intrinsic intrinsic);

  std::vector<std::string> functions_;
  std::vector<sk::program::IntrinsicUse> intrinsics_;
};

/// Replaces $T $I $U $B in a pattern of intrinsics.def by the types of the argument's width.
std::string withTypes(std::string_view pattern, ir::Type argument);

}  // namespace skc::emit
