// SPDX-License-Identifier: MIT
//
// What operators, conversions and intrinsics compute of single scalars, as docs/language.md defines them, for everything that
// interprets the IR. A scalar is a double here, which represents every bool (as 0 or 1), int, uint and float; and those integers of 64 bits whose
// magnitudes are below 2^53 (isRepresentable()). Results of real
// numbers are not rounded to float: interpreters differ in that, and round as each of them has to.
//
// How a Convert to a narrow scalar (a storage type) rounds a value of its arithmetic type:
//
//   char uchar short ushort   the low 8 or 16 bits, as in C
//   half                      the nearest half, ties to even; infinity beyond 65519.99; NaN stays NaN
//   unorm8 unorm16            k / 255 or k / 65535 for the integer k nearest to the float product
//                             x * 255 or x * 65535, ties to even; negative values and NaN give 0,
//                             values above 1 give 1
//   snorm8 snorm16            likewise with 127 and 32767, from -1 to 1
#pragma once

#include <cstdint>
#include <optional>

#include "ir/ir.hpp"

namespace skc::ir {

/// Takes and returns bits of the arithmetic type. `narrow` is a narrow scalar.
std::uint32_t quantize(Scalar narrow, std::uint32_t bits);
/// Likewise for a literal of floats, from its text, which is rounded to half once.
std::uint32_t quantize(Scalar narrow, const Literal& literal);

/// Rounds to a float that quantizes to the half that is nearest to `value`: to the nearest one if that is exact or odd, else to its
/// odd neighbour on the other side of `value`.
float roundedToOdd(double value);

/// The integer that represents 1 in unorm8, snorm8, unorm16, snorm16: 255, 127, 65535, 32767.
float normalizedScale(Scalar narrow);

/// The integer whose bits are the low bits of `value`.
double wrapped(Scalar scalar, std::int64_t value);

/// False for an integer of 64 bits that may not be the value: it is not below 2^53, or negative and of type ulong.
bool isRepresentable(Scalar scalar, double value);

double valueOf(Scalar scalar, const Literal& literal);

/// A conversion from a real number to an integer truncates and saturates, and NaN becomes 0. One to a real number keeps the
/// value, also if the type cannot represent it.
double converted(Scalar from, Scalar to, double value);

double computed(UnaryOp op, Scalar scalar, double x);

/// Integers wrap; x / 0 is x and x % 0 is 0; shift counts are taken modulo 32. `scalar` is the type of the left operand. Returns
/// nullopt if its type has no such operator.
std::optional<double> computed(BinaryOp op, Scalar scalar, double x, double y);

/// Intrinsics that are computed component by component and never round. Returns nullopt for all others.
std::optional<double> computed(Intrinsic intrinsic, Scalar scalar, double x, double y, double z);

}  // namespace skc::ir
