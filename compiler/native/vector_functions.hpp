// SPDX-License-Identifier: MIT
//
// Intrinsics of whole vectors and matrices in all lanes. A value is the list of its components; matrices are
// row-major.
#pragma once

#include <cstddef>

#include "native/formula.hpp"

namespace skc::native {

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
