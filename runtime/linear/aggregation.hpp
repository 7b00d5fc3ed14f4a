// SPDX-License-Identifier: MIT
//
// Algebraic multigrid by smoothed aggregation (P. Vanek, J. Mandel and M. Brezina, "Algebraic multigrid by smoothed aggregation for second and fourth order elliptic
// problems", 1996). The host builds the levels from the entries of a symmetric matrix alone; a V-cycle on the device is a preconditioner.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "preconditioner.hpp"
#include "sparse.hpp"

namespace sk::linear {

/// A level of the hierarchy; the transfers are those between this level and the next coarser one, and empty on the coarsest.
struct AggregationLevel {
  SparseMatrix matrix;  ///< coarse ones are restrictor * matrix * prolongator of the level before (Galerkin)
  SparseMatrix prolongator;
  /// The transpose of the prolongator times a power of two, with which the largest row sum of the coarse matrix is from 1/2 to 1.
  SparseMatrix restrictor;
  std::vector<double> inverseDiagonal;  ///< 0 where the matrix has a row of zeros
  double largestEigenvalue = 1.0;  ///< a bound for the matrix after Jacobi's scaling
};

struct AggregationHierarchy {
  std::vector<AggregationLevel> levels;  ///< at least one, the matrix itself first
  /// The pseudo-inverse of the coarsest matrix, row by row; empty if that has more than `mostOfCoarsest` rows, whose diagonals all dominate.
  std::vector<double> coarsestInverse;
};

inline constexpr std::int64_t mostOfCoarsest = 100;  ///< rows of a matrix that is solved by its inverse

/// The aggregate of each row, from 0 without gaps, or -1. `strong` is the matrix without weak entries; rows without a strong neighbour have no aggregate.
std::vector<std::int32_t> aggregatesOf(const SparseMatrix& strong);

/// The matrix without its weak entries, that is those with |a_ij| < threshold sqrt(a_ii a_jj), which are added to the diagonal, so that the row sums stay. A row keeps its
/// largest entry in any case, unless its diagonal is at least five times as large as the rest together: such a row needs no coarse level, and keeps nothing beside its diagonal.
SparseMatrix withoutWeakEntries(const SparseMatrix& a, double threshold);

/// `a` is symmetric with positive diagonal entries. Coarsens until a matrix has at most `mostOfCoarsest` rows, or no row needs a coarser level.
AggregationHierarchy aggregationHierarchy(SparseMatrix a);

/// For PreconditionerKind::make: a V-cycle with two of Chebyshev's iterations before and after the correction of each level. It is symmetric. Throws
/// sk::Error if a diagonal entry is not positive.
std::unique_ptr<Preconditioner> makeAggregation(const PreconditionerParts& parts);

}  // namespace sk::linear
