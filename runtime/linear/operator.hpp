// SPDX-License-Identifier: MIT
//
// A square matrix in double precision on the host, stored or not: what residuals are computed with, and what
// preconditioners and checks need to know of it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sparse.hpp"
#include "stencil.hpp"
#include "varying.hpp"

namespace sk::linear {

struct Operator {
  std::int64_t size = 0;
  double infinityNorm = 0.0;
  double oneNorm = 0.0;  ///< the largest sum of magnitudes of a column
  std::int64_t longestRow = 0;  ///< entries of the row that has the most
  std::vector<double> diagonal;
  std::vector<double> rowSquares;  ///< the sum of squares of each row
  /// The largest of (sum of magnitudes of a row) / |diagonal|: bounds the eigenvalues of the matrix after Jacobi's scaling.
  double jacobiBound = 0.0;
  /// Why the matrix is not symmetric, where that is known without looking at its entries; findAsymmetry looks.
  std::string asymmetry;
  bool hasConstantKernel = false;  ///< A 1 = 0, but for roundings: the matrix is singular
  std::optional<Stencil> stencil;  ///< if the matrix is one
  const SparseMatrix* sparse = nullptr;  ///< if it is not
  const VaryingStencil* varying = nullptr;  ///< the same matrix as `sparse`, if it belongs to a grid
  /// y = A x in double precision.
  std::function<std::vector<double>(std::span<const double>)> multiply;
  /// A power of two: the matrix on the device is this times A, so that its largest row sum is from 1/2 to 1.
  double scale = 1.0;

  /// If the unknowns are reordered, the row that each row was before: messages count as the matrix that was given.
  std::span<const std::int32_t> order = {};

  /// The number of a row in messages, from 1.
  std::int64_t numberOf(std::int64_t row) const {
    return (order.empty() ? row : order[static_cast<std::size_t>(row)]) + 1;
  }
  bool isGrid() const { return stencil.has_value() || varying != nullptr; }
};

/// `a` must outlive the operator. Throws sk::Error if the matrix is not square or has entries that are not finite.
Operator operatorOf(const SparseMatrix& a);
Operator operatorOf(const Stencil& a);

/// A place where the matrix differs from its transpose; "" if it is symmetric.
std::string findAsymmetry(const Operator& a);
/// The entries of the matrix, those of a stencil written out.
SparseMatrix sparseOf(const Operator& a);

/// The power of two that brings a norm to 1/2 or more, and below 1; 1 for the norm 0.
double powerOfTwo(double norm);
/// The matrix times a power of two.
SparseMatrix scaled(SparseMatrix a, double scale);
Stencil scaled(Stencil a, double scale);

}  // namespace sk::linear
