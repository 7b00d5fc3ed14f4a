// SPDX-License-Identifier: MIT
//
// Solves A x = b: chooses the limits of a method on the device, begins it anew for what is left, and reports what has been reached in double
// precision. It knows no layout and no method by name.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include <sk/linear.hpp>

#include "method.hpp"
#include "operator.hpp"

namespace sk::linear {

struct SolveSettings {
  double tolerance = 1e-8;  ///< of ||b - A x|| / ||b||, in double precision
  std::int64_t most = 10000;  ///< iterations
  std::int64_t every = 16;  ///< iterations between two looks at the residual
  std::int64_t patience =
      0;  ///< iterations without progress that are allowed, if the method itself allows fewer
  /// Mixed-precision refinement: begins anew with the residual in double precision, and adds up the solutions in double
  /// precision, until the tolerance is reached. Without it, the method runs once.
  bool refines = true;
  /// Called with the iterations so far, and the residual that the method computes, as a part of ||b||.
  std::function<void(std::int64_t, double)> progress = {};
};

/// Throws sk::Error, with its place, if an element of a right-hand side is not finite.
void checkFinite(std::span<const double> b);

class Residual;

/// `method` belongs to a matrix that is a.scale * A. Throws sk::Error if b has another size than A or is not finite.
Solution solve(Method& method, const Operator& a, std::span<const double> b, const Arithmetic& arithmetic,
               const SolveSettings& settings);
/// The same with a residual of makeResidual() for the same matrix, which serves several right-hand sides.
Solution solve(Method& method, Residual& residual, const Operator& a, std::span<const double> b,
               const Arithmetic& arithmetic, const SolveSettings& settings);

}  // namespace sk::linear
