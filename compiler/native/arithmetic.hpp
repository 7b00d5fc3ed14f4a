// SPDX-License-Identifier: MIT
//
// Operators and conversions of one scalar component in all lanes, defined for every operand as
// docs/language.md says. Integer arithmetic wraps; x / 0 is x and x % 0 is 0; shift counts are taken modulo
// 32; a conversion from a real number to an integer truncates and saturates, and NaN becomes 0.
#pragma once

#include "ir/ir.hpp"
#include "native/lanes.hpp"

namespace skc::native {

Part unary(Lanes& lanes, ir::UnaryOp op, ir::Scalar scalar, const Part& operand);
/// Both operands have the type `scalar`, except that a shift count may have the other integer type. `&&` and
/// `||` evaluate both operands.
Part binary(Lanes& lanes, ir::BinaryOp op, ir::Scalar scalar, const Part& lhs, const Part& rhs);
Part convert(Lanes& lanes, ir::Scalar from, ir::Scalar to, const Part& operand);

// Conversions between float and half (IEEE 754 binary16), rounding to nearest, ties to even. CPUs without
// instructions for them call functions, because a kernel that computes in half precision rounds after every
// operation.

/// The float with the value of the half that has these bits.
Part floatOfHalf(Lanes& lanes, const Part& bits);
/// The bits of the half nearest to a float.
Part halfOfFloat(Lanes& lanes, const Part& value);
/// Rounds a float to half precision; the result is a float.
Part roundedToHalf(Lanes& lanes, const Part& value);

}  // namespace skc::native
