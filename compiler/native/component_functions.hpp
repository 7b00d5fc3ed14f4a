// SPDX-License-Identifier: MIT
//
// Intrinsics of one component in all lanes that are too long for a row of ir/intrinsics.def.
#pragma once

#include "native/formula.hpp"

namespace skc::native {

/// IEEE 754's minNum and maxNum: if one argument is a NaN, the result is the other; -0 is below +0.
Part minimum(const Formula& f, ir::Scalar scalar, const Part& x, const Part& y);
Part maximum(const Formula& f, ir::Scalar scalar, const Part& x, const Part& y);
Part absolute(const Formula& f, ir::Scalar scalar, const Part& x);
Part sign(const Formula& f, ir::Scalar scalar, const Part& x);
/// x - floor(x), but always below 1, even if x is slightly below an integer; NaN for infinity.
Part fraction(const Formula& f, const Part& x);
/// The remainder with the sign of y: fmod(x, y), which is exact, plus y if their signs differ.
Part modulo(const Formula& f, const Part& x, const Part& y);
/// x * (1 - t) + y * t, where x itself belongs to 0 and y to 1, with the sign of a zero.
Part mix(const Formula& f, const Part& x, const Part& y, const Part& t);
Part clamp(const Formula& f, ir::Scalar scalar, const Part& x, const Part& low, const Part& high);
Part smoothstep(const Formula& f, const Part& low, const Part& high, const Part& x);

/// Conversions between a number, rounded to float, and the bits of that float.
Part bitsOf(const Formula& f, const Part& x);
Part realOfBits(const Formula& f, const Part& x);
Part frexpExponent(const Formula& f, const Part& x);
Part frexpMantissa(const Formula& f, const Part& x);
/// x - trunc(x), with the sign of x; 0 for infinity.
Part modfFraction(const Formula& f, const Part& x);
/// x * 2^e, rounded once.
Part ldexp(const Formula& f, const Part& number, const Part& exponent);

/// The rounding error of a sum (Knuth, TAOCP 2, 4.2.2).
Part sumError(const Formula& f, const Part& a, const Part& c);
/// The rounding error of a product; 0 if the product is not finite.
Part productError(const Formula& f, const Part& x, const Part& y);

/// floor(x), in each lane.
Part floorOf(Lanes& lanes, const Part& x);
/// Converts a whole real number to an index. As on every device, NaN becomes 0, and the largest index is the
/// largest int that is a float.
Part wholeIndex(Lanes& lanes, const Part& x);

}  // namespace skc::native
