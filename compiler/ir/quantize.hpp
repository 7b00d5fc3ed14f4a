// SPDX-License-Identifier: MIT
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

}  // namespace skc::ir
