// SPDX-License-Identifier: MIT
//
// The surface of shallow water in a pool with reflecting walls: u'' = c^2 Laplace(u), implicit in time (J. Krueger and R. Westermann, "Linear algebra
// operators for GPU implementation of numerical algorithms", 2003). Each step solves (I + theta^2 (c dt / h)^2 L) w = u + theta dt u' by conjugate
// gradients; L is minus the Laplacian times h^2, and no matrix is stored.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sk/sk.hpp>

#include "method.hpp"
#include "support/grid_stream.hpp"

namespace linear = sk::linear;

namespace waves {

enum class Scheme { CrankNicolson, BackwardEuler };

struct Model {
  std::int64_t width = 128, height = 128;  ///< cells
  double spacing = 1.0 / 128.0;  ///< h
  double speed = 1.0;  ///< c, of waves
  double timeStep = 1.0 / 128.0;  ///< dt
  Scheme scheme = Scheme::CrankNicolson;
  double tolerance = 1e-6;  ///< of ||b - A w|| / ||b|| in each step
  int mostIterations = 200;  ///< of each step
  sk::Precision precision = sk::Precision::Single;

  double theta() const { return scheme == Scheme::CrankNicolson ? 0.5 : 1.0; }
  /// The square of the Courant number c dt / h, as a float holds it: kernels and checks compute with the same one.
  double lambdaSquared() const;
  /// theta^2 (c dt / h)^2.
  double coefficient() const { return theta() * theta() * lambdaSquared(); }
  /// Half the distance from 1 to the next number that the precision holds.
  double roundoff() const;
  /// The least residual that the precision allows: each of the terms of b - A w is rounded, and ||A|| is at most 1 + 8 coefficient().
  double attainable() const { return 4.0 * roundoff() * (1.0 + 8.0 * coefficient()); }
};

struct Step {
  std::int64_t iterations = 0;
  double residual = 0.0;  ///< ||b - A w|| / ||b||, of the w that the step has used
  double length = 0.0;  ///< ||b||
  bool reached = true;  ///< the tolerance, or the least residual that the precision allows
};

class Surface {
 public:
  /// At rest. Throws std::runtime_error for a model with a number that is not positive.
  Surface(sk::Device& device, const Model& model);
  /// The same in a space of the shape {height, width}, which may be divided over ranks: then all functions are collective, and sums are exact, so
  /// that no bit depends on the number of ranks.
  Surface(const linear::Space& space, const Model& model);
  /// Matrices in here refer to the model.
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  const Model& model() const { return model_; }
  std::int64_t steps() const { return steps_; }
  double time() const { return static_cast<double>(steps_) * model_.timeStep; }

  /// Row-major, height * width values; the first row is the near wall. If the surface is divided, rank 0 gives and gets them, and the others get none.
  void writeHeights(std::span<const double> values);
  void writeVelocities(std::span<const double> values);  ///< per time
  std::vector<double> heights() const { return u_.readReals(); }
  std::vector<double> velocities() const;
  const linear::Vector& heightStream() const { return u_; }
  const linear::Space& space() const { return space_; }

  /// Throws std::runtime_error, "step N: ...", if a number is not finite.
  Step step();

  /// Kinetic and potential energy for a density of 1: the integral of (u'^2 + c^2 |grad u|^2) / 2, in double precision. 0 on ranks other than the first.
  double energy() const;
  /// How much a step with this residual can change the energy: its residual's part is at most 8 (c dt / h) sqrt(E) ||r|| (in the units of q), and the
  /// rounding of u and q acts like a residual.
  double energyBound(const Step& step, double energy) const;
  /// ||b - A w|| / ||b|| of the last step, computed in double precision on the host. 0 on ranks other than the first.
  double residualInDouble() const;

 private:
  linear::Vector stream() const { return space_.stream<float>(arithmetic_.vectors); }

  linear::Space space_;
  Model model_;
  linear::Arithmetic arithmetic_;
  linear::Vector u_, q_, un_, qn_, b_, w_, change_, r_;
  linear::Vector sum_;  ///< of one element
  std::unique_ptr<linear::Matrix> matrix_;
  std::unique_ptr<linear::Method> method_;
  std::int64_t steps_ = 0;
};

}  // namespace waves
