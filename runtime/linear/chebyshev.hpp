// SPDX-License-Identifier: MIT
//
// A fixed number of Chebyshev's iterations after Jacobi's scaling: by itself a preconditioner, and the smoother of algebraic multigrid.
#pragma once

#include <span>

#include <sk/sk.hpp>

#include "matrix.hpp"

namespace sk::linear {

struct ChebyshevSettings {
  int steps = 4;
  double low = 0.0, high = 0.0;  ///< the interval of eigenvalues of D^-1 A on which the error becomes small
};

/// For D^-1 A z = D^-1 r (Saad, "Iterative methods for sparse linear systems", 12.3.2), where the diagonal of D^-1 is `inverseDiagonal`. Calls may be recorded
/// in a loop.
class ChebyshevSteps {
 public:
  /// `matrix` is square and outlives the steps.
  ChebyshevSteps(sk::Device& device, Matrix& matrix, std::span<const double> inverseDiagonal,
                 const ChebyshevSettings& settings, const Arithmetic& arithmetic);

  /// Iterates from z = 0.
  void begin(const Vector& r, Vector& z);
  /// Iterates from z as it is.
  void advance(const Vector& r, Vector& z);

 private:
  /// The steps after the first one.
  void finish(const Vector& r, Vector& z);

  Matrix& matrix_;
  Vector inverse_, change_, product_;
  sk::CallOptions options_;
  int steps_;
  double middle_, radius_;
};

}  // namespace sk::linear
