// SPDX-License-Identifier: MIT
//
// What a Convert to a narrow scalar makes of its carrier's value:
//
//   char uchar short ushort   the low 8 or 16 bits, as C does
//   half                      the nearest half, of two the even one; infinity beyond 65519.99; NaN stays NaN
//   unorm8 unorm16            k / 255 or k / 65535 for the integer k nearest to the float product
//                             x * 255 or x * 65535, of two the even one; 0 for what is below 0 and for
//                             NaN, 1 for what is above 1
//   snorm8 snorm16            likewise with 127 and 32767, from -1 to 1
#pragma once

#include <cstdint>

#include "ir/type.hpp"

namespace skc::ir {

/// Bits of the carrier to bits of the carrier. `narrow` is a narrow scalar.
std::uint32_t quantize(Scalar narrow, std::uint32_t bits);

/// The value that stands for 1 in unorm8, snorm8, unorm16, snorm16: 255, 127, 65535, 32767.
float normalizedScale(Scalar narrow);

}  // namespace skc::ir
