// SPDX-License-Identifier: MIT
//
// Implicit mean-curvature flow (M. Desbrun, M. Meyer, P. Schroeder and A. Barr, "Implicit fairing of irregular meshes using diffusion and
// curvature flow", 1999): points move by the Laplacian of their positions on the surface, which is minus twice the mean curvature along the
// normal. A sphere's radius becomes sqrt(r^2 - 4 t).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <sk/sk.hpp>

#include "surface.hpp"

namespace smooth {

struct FlowSettings {
  double timeStep = 1e-3;  ///< a squared length
  bool keepsVolume = false;  ///< scales about the centre after each step, for closed surfaces
  bool fixesBoundary = true;  ///< otherwise boundaries shrink, too
  std::string layout = "auto";  ///< of the matrix, as solve --layout takes it
  std::string precision = "auto";  ///< "single", "extended", "double", or "auto" for what the matrix needs
  double tolerance = 1e-8;  ///< of a step's true residual
  /// Iterations of a solve with Jacobi's preconditioner, after which multigrid takes its place.
  std::int64_t jacobiIterations = 4000;
};

/// What a step's backward error may be if its residual stays above the tolerance: 512 roundings of doubles, less than the cotangents of thin triangles lose.
inline constexpr double mostBackwardError = 0x1p-44;

struct StepReport {
  std::int64_t iterations = 0;  ///< of three solves, for x, y and z
  double residual =
      0.0;  ///< the largest of their true residuals, as a part of the right-hand side, with rows and columns scaled by the diagonal
  /// The largest backward error (linear::Solution) of solves whose residual stays above the tolerance because no double x is better; 0 if all reach it.
  double backwardError = 0.0;
  double volume = 0.0;
  double area = 0.0;
  double secondsSolving =
      0.0;  ///< of the step, in the three solves; the rest computes the matrix and copies it to the device
};

/// The names that FlowSettings::precision takes.
std::span<const std::string_view> precisionNames();

class Flow {
 public:
  /// Throws std::runtime_error if the surface has no face with an area, or if its volume cannot be kept.
  Flow(sk::Device& device, Surface surface, const FlowSettings& settings);
  ~Flow();
  Flow(Flow&&) noexcept;

  /// Throws std::runtime_error if the equations are not solved, to the tolerance or as exactly as doubles can.
  StepReport step();

  const Surface& surface() const { return surface_; }
  const Faults& faults() const { return faults_; }
  /// The layout in use; settings.layout before the first step.
  const std::string& layout() const { return layout_; }
  /// The precision of the latest step's iterations; settings.precision before the first.
  const std::string& precision() const { return precision_; }
  /// The preconditioner of the latest step's iterations: "jacobi", or "aggregation" from the step on that needs it. Empty before the first.
  std::string_view preconditioner() const;

 private:
  class Solver;  ///< flow.cpp's own

  void restoreVolume();
  /// What to do if a step's equations were not solved.
  std::string wayOut() const;

  sk::Device& device_;
  Surface surface_;
  FlowSettings settings_;
  Faults faults_;
  std::string layout_, precision_;
  double volume_, area_;  ///< at first
  std::unique_ptr<Solver> solver_;  ///< made by the first step
  std::int64_t steps_ = 0;
};

}  // namespace smooth
