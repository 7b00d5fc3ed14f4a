// SPDX-License-Identifier: MIT
//
// The functions that rows of ir/intrinsics.def name, because what they compute is too long for a row.
#pragma once

#include <cstddef>

#include "native/scalar_builder.hpp"

namespace skc::native {

// ---- of one component in all lanes (intrinsic_functions.cpp) ----------------------------------

/// IEEE 754's minNum and maxNum: if one argument is a NaN, the result is the other; -0 is below +0.
Part minimum(const ScalarBuilder& f, ir::Scalar scalar, const Part& x, const Part& y);
Part maximum(const ScalarBuilder& f, ir::Scalar scalar, const Part& x, const Part& y);
Part absolute(const ScalarBuilder& f, ir::Scalar scalar, const Part& x);
Part sign(const ScalarBuilder& f, ir::Scalar scalar, const Part& x);
/// x - floor(x), but always below 1, even if x is slightly below an integer; NaN for infinity.
Part fraction(const ScalarBuilder& f, const Part& x);
/// The remainder with the sign of y: fmod(x, y), which is exact, plus y if their signs differ.
Part modulo(const ScalarBuilder& f, const Part& x, const Part& y);
/// x * (1 - t) + y * t, where x itself belongs to 0 and y to 1, with the sign of a zero.
Part mix(const ScalarBuilder& f, const Part& x, const Part& y, const Part& t);
Part clamp(const ScalarBuilder& f, ir::Scalar scalar, const Part& x, const Part& low, const Part& high);
Part smoothstep(const ScalarBuilder& f, const Part& low, const Part& high, const Part& x);

/// Conversions between a number, rounded to float, and the bits of that float.
Part bitsOf(const ScalarBuilder& f, const Part& x);
Part realOfBits(const ScalarBuilder& f, const Part& x);
Part frexpExponent(const ScalarBuilder& f, const Part& x);
Part frexpMantissa(const ScalarBuilder& f, const Part& x);
/// x - trunc(x), with the sign of x; 0 for infinity.
Part modfFraction(const ScalarBuilder& f, const Part& x);
/// x * 2^e, rounded once.
Part ldexp(const ScalarBuilder& f, const Part& number, const Part& exponent);

/// The number of bits that are set in an integer of 32 or 64 bits, as an int.
Part bitCount(const ScalarBuilder& f, const Part& x);
/// The number of zeros in front of the highest bit that is set, or behind the lowest; 32 or 64 of 0.
Part leadingZeros(const ScalarBuilder& f, const Part& x);
Part trailingZeros(const ScalarBuilder& f, const Part& x);
/// The upper half of the product of two integers of a type.
Part multiplyHigh(const ScalarBuilder& f, ir::Scalar scalar, const Part& x, const Part& y);

/// The rounding error of a sum (Knuth, TAOCP 2, 4.2.2).
Part sumError(const ScalarBuilder& f, const Part& a, const Part& c);
/// The rounding error of a product; 0 if the product is not finite.
Part productError(const ScalarBuilder& f, const Part& x, const Part& y);

/// floor(x), in each lane.
Part floorOf(Lanes& lanes, const Part& x);
/// Converts a whole real number to an index. As on every device, NaN becomes 0, and the largest index is the
/// largest int that is a float.
Part toIndex(Lanes& lanes, const Part& x);

// ---- of whole vectors and matrices in all lanes (intrinsic_functions.cpp) ------------------------
// A value is the list of its components; matrices are row-major.

Parts minus(const ScalarBuilder& f, const Parts& a, const Parts& c);
Part dot(const ScalarBuilder& f, const Parts& a, const Parts& c);
/// Scales `a` first, so that no square overflows or underflows.
Part length(const ScalarBuilder& f, const Parts& a);
/// Returns a zero vector unchanged.
Parts normalize(const ScalarBuilder& f, const Parts& a);
Parts cross(const ScalarBuilder& f, const Parts& a, const Parts& c);
Parts faceforward(const ScalarBuilder& f, const Parts& n, const Parts& i, const Parts& reference);
Parts reflect(const ScalarBuilder& f, const Parts& i, const Parts& n);
Parts refract(const ScalarBuilder& f, const Parts& i, const Parts& n, const Part& eta);

Parts transpose(const Parts& m, std::size_t n);
Part determinant(const ScalarBuilder& f, const Parts& m, std::size_t n);
/// By cofactors, as GLSL's implementations do. A singular matrix gives infinities and NaN.
Parts inverse(const ScalarBuilder& f, const Parts& m, std::size_t n);

Part anyOf(const ScalarBuilder& f, const Parts& parts);
Part allOf(const ScalarBuilder& f, const Parts& parts);

}  // namespace skc::native
