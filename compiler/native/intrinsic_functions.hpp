// SPDX-License-Identifier: MIT
//
// The functions that rows of ir/intrinsics.def name, because what they compute is too long for a row.
#pragma once

#include <cstddef>

#include "native/formula.hpp"

namespace skc::native {

// ---- of one component in all lanes (component_functions.cpp) ----------------------------------

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

// ---- of whole vectors and matrices in all lanes (vector_functions.cpp) ------------------------
// A value is the list of its components; matrices are row-major.

Parts minus(const Formula& f, const Parts& a, const Parts& c);
Part dot(const Formula& f, const Parts& a, const Parts& c);
/// Scales `a` first, so that no square overflows or underflows.
Part length(const Formula& f, const Parts& a);
/// Returns a zero vector unchanged.
Parts normalize(const Formula& f, const Parts& a);
Parts cross(const Formula& f, const Parts& a, const Parts& c);
Parts faceforward(const Formula& f, const Parts& n, const Parts& i, const Parts& reference);
Parts reflect(const Formula& f, const Parts& i, const Parts& n);
Parts refract(const Formula& f, const Parts& i, const Parts& n, const Part& eta);

Parts transpose(const Parts& m, std::size_t n);
Part determinant(const Formula& f, const Parts& m, std::size_t n);
/// By cofactors, as GLSL's implementations do. A singular matrix gives infinities and NaN.
Parts inverse(const Formula& f, const Parts& m, std::size_t n);

Part anyOf(const Formula& f, const Parts& parts);
Part allOf(const Formula& f, const Parts& parts);

}  // namespace skc::native
