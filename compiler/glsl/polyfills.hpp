// SPDX-License-Identifier: MIT
//
// The functions that a body needs beside the user's because GLSL 3.30 lacks them: collected while
// expressions are printed, each once, in the order of first use.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

class Polyfills {
 public:
  /// The function of an intrinsic's row, for this type of its first argument.
  void intrinsic(ir::Intrinsic intrinsic, ir::Type argument);
  /// && or || of two bool vectors; returns the function's name.
  std::string logical(ir::BinaryOp op, int width);
  /// A choice by component between two vectors of int, uint or bool; returns the function's name.
  std::string select(ir::Type type);
  /// / or % of integers that is defined for all of them; returns the function's name. GLSL's are not where the divisor
  /// is 0, the quotient too large, or, for %, an operand negative.
  std::string quotient(ir::BinaryOp op, ir::Type lhs, ir::Type rhs);
  /// A conversion of reals to the nearest integer toward 0 that the type has, of NaN to 0; returns the function's name.
  std::string truncated(ir::Type to);
  /// An intrinsic that the assembler defines, on arguments of this width; returns the function's name.
  std::string defined(sk::program::Intrinsic intrinsic, int width);
  /// Likewise on one double.
  std::string definedOfDouble(sk::program::Intrinsic intrinsic);

  /// A Convert of the carrier's value to a narrow type; returns the function's name.
  std::string quantize(ir::Type type);

  /// Any other function, unless this very one is there.
  void add(std::string function);

  /// Their definitions.
  const std::vector<std::string>& functions() const { return functions_; }
  /// What is left to the assembler.
  const std::vector<sk::program::IntrinsicUse>& intrinsics() const { return intrinsics_; }

 private:
  sk::program::IntrinsicUse& use(sk::program::Intrinsic intrinsic);

  std::vector<std::string> functions_;
  std::vector<sk::program::IntrinsicUse> intrinsics_;
};

/// A pattern of intrinsics.def with $T $I $U $B replaced by the types of the argument's width.
std::string withTypes(std::string_view pattern, ir::Type argument);

}  // namespace skc::emit
