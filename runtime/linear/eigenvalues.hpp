// SPDX-License-Identifier: MIT
//
// Eigenvalues of symmetric matrices on the host: extreme ones for the intervals of iterations, and all of them for inverses of small matrices.
#pragma once

#include <span>
#include <vector>

#include "sparse.hpp"

namespace sk::linear {

/// The smallest or the largest eigenvalue of a symmetric tridiagonal matrix with these elements on and beside the diagonal, by bisection: the signs of the
/// pivots of T - x count the eigenvalues below x (Golub and Van Loan, "Matrix computations", 8.4.1). `diagonal` is not empty.
double tridiagonalEigenvalue(const std::vector<double>& diagonal, const std::vector<double>& beside,
                             bool isSmallest);

/// A bound of the largest eigenvalue of D^-1 A for a symmetric A with the diagonal 1 / inverseDiagonal, which is not negative: 1.1 times the largest value of a few
/// steps of Lanczos's method, or the largest row sum of magnitudes if that is less. A row whose inverse is 0 does not count.
double jacobiEigenvalueBound(const SparseMatrix& a, std::span<const double> inverseDiagonal);

/// The pseudo-inverse of a symmetric matrix of n x n elements, row by row: eigenvalues of a magnitude up to 2^-44 of the largest count as 0. By Jacobi's rotations (Golub
/// and Van Loan, 8.5.3), whose cost grows with n^3: for n up to about a hundred.
std::vector<double> pseudoInverse(std::vector<double> matrix, std::size_t n);

}  // namespace sk::linear
