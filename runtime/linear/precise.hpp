// SPDX-License-Identifier: MIT
//
// Residuals near the rounding errors of doubles, on the host. b - A x subtracts numbers that are almost equal, and what is left of them in doubles may be
// rounding errors alone.
#pragma once

#include <span>
#include <vector>

#include "operator.hpp"

namespace sk::linear {

/// The 2-norm of a vector, and a bound of the error of `two`, which includes the errors of the vector's elements.
struct Norms {
  double two = 0.0;
  double infinity = 0.0;
  double error = 0.0;
};

/// For a vector whose elements are exact.
Norms normsOf(std::span<const double> v);

/// A bound of the 2-norm of the rounding errors in b - A x, if each row is computed in doubles in any order: the products, the sums, the row sums of a varying
/// stencil, and an A in up to three parts (residual.hpp). `normA` and the other two belong to what is multiplied.
double roundingOfResidual(const Operator& a, double normA, double normX, double normB);
/// A bound of the 2-norm of the matrix: the root of the product of its largest column sum and its largest row sum.
double boundOfNorm(const Operator& a);

/// b - scale * A x, where scale is a power of two, as if it were computed with twice the digits of a double and then rounded (T. Ogita, S. Rump and S. Oishi,
/// "Accurate sum and dot product", 2005: Dot2). `norms` are those of the result.
struct PreciseResidual {
  std::vector<double> r;
  Norms norms;
};
PreciseResidual preciseResidual(const Operator& a, double scale, std::span<const double> x,
                                std::span<const double> b);

/// Whether the norm is known to 1 %.
inline bool isKnown(const Norms& norms) { return !(norms.error > 0.01 * norms.two); }

}  // namespace sk::linear
