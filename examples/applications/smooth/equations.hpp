// SPDX-License-Identifier: MIT
//
// The linear equations of one implicit step of mean-curvature flow, (M + dt L) x' = M x. L has the weights of cotangents (M. Desbrun and others, 1999); M has a
// third of the area of each face at its points. Everything is computed in double precision on the host.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sparse.hpp"
#include "surface.hpp"

namespace linear = sk::linear;

namespace smooth {

class Equations {
 public:
  /// The places of the entries, which depend on the faces alone: an entry for each point and for both directions of each edge. Those of
  /// degenerate faces and of points that stay are there, too, and are 0.
  explicit Equations(const Surface& surface);

  /// Computes the values from the positions of the same surface's points. `timeStep` is dt, a squared length; with
  /// `fixesBoundary` the points of the boundary stay.
  void update(const Surface& surface, const Faults& faults, double timeStep, bool fixesBoundary);

  /// M + dt L; rows of points that stay are a multiple of the identity's.
  const linear::SparseMatrix& matrix() const { return matrix_; }
  /// dt L; rows of points that stay are 0.
  const linear::SparseMatrix& laplacian() const { return laplacian_; }
  /// A bound below the least eigenvalue of the matrix after Jacobi's scaling: L is positive semidefinite, so that x . (M + dt L) x is at least x . M x,
  /// which is at least this part of x . D x with the diagonal D.
  double leastEigenvalue() const { return leastEigenvalue_; }
  /// The largest of these parts, of points that move. Where it is below the roundings of doubles, the matrix is dt L alone.
  double largestMass() const { return largestMass_; }
  /// Subtracts from a change of the points what moves the centre of a part of the surface, weighted by M, if none of its points stays: a step keeps these
  /// centres. Where M is too small to be seen in the matrix, the equations leave them open.
  void keepCentres(std::span<double> change) const;

 private:
  linear::SparseMatrix matrix_, laplacian_;  ///< with the same places
  std::vector<std::size_t> diagonal_;  ///< the entry of each point
  /// For each face and corner, the entries of the opposite edge in both directions; unused if the face names a point twice.
  std::vector<std::array<std::array<std::size_t, 2>, 3>> edges_;
  std::vector<std::int32_t> part_;  ///< a point of the connected part that each point belongs to
  std::vector<double> mass_;
  std::vector<bool> stays_;
  double leastEigenvalue_ = 1.0, largestMass_ = 0.0;
};

}  // namespace smooth
