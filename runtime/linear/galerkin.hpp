// SPDX-License-Identifier: MIT
//
// Coarse grids for matrices whose coefficients differ from element to element: interpolation that follows the matrix (J. Dendy, "Black box multigrid", 1982), and
// Galerkin's coarse matrices. It knows no device.
#pragma once

#include <vector>

#include "varying.hpp"

namespace sk::linear {

/// Elements of grids that are not made coarser. Errors that are constant where a coefficient is large, and that a coarser grid cannot show, would hardly decrease.
inline constexpr std::int64_t solvedDirectly = 400;

/// A grid of every `step`-th element, from `first` on, of each dimension, and its interpolation.
struct Coarsening {
  sk::Shape coarse;
  GridOffset step{1, 1, 1}, first{};  ///< 0 being the slowest dimension
  /// weight[k * coarse.size() + j] is the weight of coarse element j for the fine element at an offset from it: k counts the 3^rank offsets from -1 to 1 along
  /// each dimension, those of the fastest dimension first.
  std::vector<double> weight;

  /// Fine elements for each coarse one.
  int share() const { return step[0] * step[1] * step[2]; }
};

/// Halves the dimensions that have more than three elements and along which the matrix couples at least a quarter as strongly as along the strongest of these. Elements between
/// coarse ones take the value that their own equations give, where sums over the dimensions in which they do not lie between coarse elements stand for the entries. So interpolation keeps
/// the flux, not the slope, where a coefficient jumps. The extents are those of `a` if it has at most 400 elements, or nothing is left to halve.
Coarsening coarsening(const VaryingStencil& a);

/// P^T A P / share, where P is the interpolation.
VaryingStencil galerkin(const VaryingStencil& a, const Coarsening& coarsening);

/// An inverse of a symmetric matrix without negative eigenvalues, row by row: G with A G A = A, where A is singular. For small matrices, by Cholesky's factors after
/// scaling with the diagonal; a pivot that is 0, but for roundings, leaves its unknown 0, and so does the
/// last one if constants are in the kernel, after which G keeps means 0 (G. Golub and C. Van Loan, "Matrix computations", 4.2.8).
std::vector<double> symmetricInverse(const VaryingStencil& a, bool hasConstantKernel);

}  // namespace sk::linear
