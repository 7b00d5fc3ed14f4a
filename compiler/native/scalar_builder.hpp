// SPDX-License-Identifier: MIT
//
// Arithmetic of one component in all lanes, in the notation of formulas. The rows of ir/intrinsics.def and
// the functions that they name (intrinsic_functions.hpp) are written in it.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <llvm/IR/Intrinsics.h>

#include "native/arithmetic.hpp"

namespace skc::native {

class ScalarBuilder {
 public:
  using BinaryOp = ir::BinaryOp;
  using Scalar = ir::Scalar;

  explicit ScalarBuilder(Lanes& lanes) : l(lanes) {}

  Lanes& l;

  Part add(const Part& a, const Part& c) const { return op(BinaryOp::Add, a, c); }
  Part sub(const Part& a, const Part& c) const { return op(BinaryOp::Sub, a, c); }
  Part mul(const Part& a, const Part& c) const { return op(BinaryOp::Mul, a, c); }
  Part div(const Part& a, const Part& c) const { return op(BinaryOp::Div, a, c); }
  /// a * c + d: rounded once where the flags of the builder allow contraction, else twice. A product and a sum would stay apart
  /// where the product has another use.
  Part multiplyAdd(const Part& a, const Part& c, const Part& d) const;
  Part less(const Part& a, const Part& c) const { return op(BinaryOp::Less, a, c); }
  Part equal(const Part& a, const Part& c) const { return op(BinaryOp::Equal, a, c); }
  Part differs(const Part& a, const Part& c) const { return op(BinaryOp::NotEqual, a, c); }
  Part both(const Part& a, const Part& c) const { return logic(BinaryOp::LogicalAnd, a, c); }
  Part either(const Part& a, const Part& c) const { return logic(BinaryOp::LogicalOr, a, c); }
  Part select(const Part& c, const Part& yes, const Part& no) const { return l.select(c, yes, no); }
  Part negate(const Part& x) const { return unary(l, ir::UnaryOp::Negate, Scalar::Float, x); }

  /// A constant of the type of `like`.
  Part number(const Part& like, double value) const;
  /// A constant with more digits or a larger exponent than a double has, decimal or hexadecimal.
  Part decimal(const Part& like, const char* text) const;

  Part abs(const Part& x) const;
  Part copySign(const Part& magnitude, const Part& sign) const;
  Part isInfinite(const Part& x) const { return equal(abs(x), number(x, infinity)); }
  Part isFinite(const Part& x) const { return less(abs(x), number(x, infinity)); }
  /// True if the sign bit is set, also for -0 and NaN.
  Part isNegative(const Part& x) const;

  Part sqrt(const Part& x) const { return instruction(llvm::Intrinsic::sqrt, "sqrt", x); }
  Part floor(const Part& x) const { return instruction(llvm::Intrinsic::floor, "floor", x); }
  Part trunc(const Part& x) const { return instruction(llvm::Intrinsic::trunc, "trunc", x); }
  /// An operation for which CPUs have an instruction; for binary128, the function `name` of libm.
  Part instruction(llvm::Intrinsic::ID id, const char* name, const Part& x) const;

  /// Calls a function of the C library lane by lane. The type of its first argument selects the variant and
  /// is the type of the result.
  Part libm(std::string name, const std::vector<Part>& x) const;
  /// The suffix of functions of binary128: libquadmath's or, if long double is binary128, the C library's.
  const char* quadSuffix() const;

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  Part op(BinaryOp o, const Part& a, const Part& c) const { return binary(l, o, Scalar::Float, a, c); }
  Part logic(BinaryOp o, const Part& a, const Part& c) const { return binary(l, o, Scalar::Bool, a, c); }
};

}  // namespace skc::native
