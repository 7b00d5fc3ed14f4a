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

#include "method.hpp"
#include "operator.hpp"

namespace linear {

enum class Outcome {
  Converged,
  SingularAndCompatible,  ///< converged; any constant may be added to x. Grids drop the mean of b
  SingularAndIncompatible,  ///< no x solves the equations: rows and columns add up to 0, and b does not
  MostIterations,
  Stagnated,  ///< the residual in double precision does not become smaller any more
  NotPositiveDefinite,
  Breakdown,
  NotFinite,
};
std::string_view nameOf(Outcome outcome);

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

/// A residual as the method computed it, as a part of ||b||.
struct HistoryPoint {
  std::int64_t iteration = 0;
  double residual = 0.0;
};

struct Solution {
  std::vector<double> x;  ///< the best that was found
  Outcome outcome = Outcome::Stagnated;
  std::int64_t iterations = 0;
  std::int64_t restarts = 0;
  double residualTrue =
      0.0;  ///< ||b - A x|| / ||b||, computed in double precision, or in more where that is not enough; 2-norms
  /// A bound of the error of residualTrue: at most a hundredth of it, unless it is close to the range's end.
  double residualError = 0.0;
  double residualRecurred = 0.0;  ///< the same, as the method computed it last
  double backwardError = 0.0;  ///< ||b - A x|| / (||A|| ||x|| + ||b||); infinity norms
  std::string_view residualPlace = "host";  ///< where the true residual was computed: "device" or "host"
  /// On singular grids, the mean of b: no x reaches a constant. It was removed, and the residual is that of the rest; x has the mean 0.
  double removedMean = 0.0;
  double seconds = 0.0;
  std::vector<HistoryPoint> history;
};

class Residual;

/// `method` belongs to a matrix that is a.scale * A. Throws std::runtime_error if b has another size than A or is not finite.
Solution solve(Method& method, const Operator& a, std::span<const double> b, const Arithmetic& arithmetic,
               const SolveSettings& settings);
/// The same with a residual of makeResidual() for the same matrix, which serves several right-hand sides.
Solution solve(Method& method, Residual& residual, const Operator& a, std::span<const double> b,
               const Arithmetic& arithmetic, const SolveSettings& settings);

}  // namespace linear
