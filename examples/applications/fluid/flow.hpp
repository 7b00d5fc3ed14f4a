// SPDX-License-Identifier: MIT
//
// A flow on a device: its fields, and the step that its model makes of them. Passes that a model does not need are not made, and streams that it does
// not need do not exist.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <sk/sk.hpp>

#include "equations.hpp"
#include "method.hpp"
#include "model.hpp"
#include "preconditioner.hpp"

namespace fluid {

/// The result of one projection. Divergences are the largest |div u|, in 1 / time.
struct Projection {
  double before = 0.0, after = 0.0;
  std::int64_t iterations = 0;
  double residual =
      0.0;  ///< root mean square of div u * spacing over the largest speed, from the velocities themselves
  double recurred = 0.0;  ///< the same as the solver computed it
  bool reached = true;  ///< the tolerance
};

struct Step {
  double timeStep = 0.0;
  double speed = 0.0;  ///< the largest component of the velocity before the step
  double cfl = 0.0;  ///< speed * time step / spacing
  Projection projection;  ///< the last one, with the iterations of all
};

enum class Scalar { Smoke, Heat };

/// The largest Courant number of flows that are divided over ranks: how far kernels read, as transport.sk promises, follows from it.
inline constexpr double farthestCarried = 4.0;

class Flow {
 public:
  /// At rest but for what walls and inflows give, and `inside`. Throws std::runtime_error for a model with a contradiction.
  Flow(sk::Device& device, const Model& model, const Triple& inside = {});
  /// The same in a space of the model's shape, which may be divided over ranks: then all functions are collective, the first rank gives and gets all
  /// values and the others none, and sums are exact, so that no bit depends on the number of ranks.
  Flow(const linear::Space& space, const Model& model, const Triple& inside = {});

  const Model& model() const { return model_; }
  double time() const { return time_; }
  std::int64_t steps() const { return steps_; }

  /// Row-major with the layer around the grid: the shape of the model.
  void writeVelocity(int axis, std::span<const double> values) { velocity_[at(axis)].writeReals(values); }
  void write(Scalar scalar, std::span<const double> values) { stream(scalar).writeReals(values); }
  std::vector<double> velocity(int axis) const { return velocity_[at(axis)].readReals(); }
  std::vector<double> values(Scalar scalar) { return stream(scalar).readReals(); }
  const linear::Vector& velocityStream(int axis) const { return velocity_[at(axis)]; }
  /// Throws std::logic_error for a scalar that the model has not.
  linear::Vector& stream(Scalar scalar);

  /// Makes the velocity that has been written free of divergence.
  Projection project() { return project(0, surveyed()); }
  /// Throws std::runtime_error, "step N: u is not finite in cell (x, y)", before a step that would spread it, or, if the space is divided, that would carry something
  /// farther than `farthestCarried` cells. `longest` bounds the time step.
  Step step(double longest = 1e300);
  /// Throws as step() does.
  void requireFinite() { surveyed(); }

  /// max |div u| in double precision.
  double divergence();
  /// The root mean square of div u * spacing, in double precision.
  double divergenceMean();
  double kineticEnergy()
      const;  ///< of the fluid, with density 1: half of a face's square beside a wall, nothing of walls
  double total(Scalar scalar);  ///< times the volume of a cell
  std::pair<double, double> range(Scalar scalar);
  const GridArguments& grid() const { return *grid_; }
  const linear::Space& space() const { return grid_->space; }

  int streams() const;
  /// Those of a model.
  static int streamsOf(const Model& model);

 private:
  static std::size_t at(int axis) { return static_cast<std::size_t>(axis); }
  linear::Vector makeStream() const { return space().stream<float>(arithmetic_.vectors); }
  /// The divergence in double precision, times the spacing.
  std::vector<double> exactDivergence();
  sk::Optional<sk::In<float>> along(int axis) const;
  double surveyed();
  double surveyOne(const linear::Vector& stream, const char* name);
  double chosenTimeStep(double speed) const;
  void checkCarried(double cells) const;

  void holdSources();
  void transport(double dt);
  void carryOne(int axis, double step, const linear::Vector& from, linear::Vector& to);
  void accelerate(double dt, bool convects, double keep);
  void diffuse(double dt, double speed);
  Projection project(std::size_t stage, double speed);
  std::pair<double, double> measureInflows();
  void subtract(const linear::Vector& q);
  void extendVelocity();

  Model model_;
  linear::Arithmetic arithmetic_;
  sk::CallOptions options_;
  std::unique_ptr<GridArguments> grid_;  ///< matrices refer to it, also after the flow has moved
  std::int64_t fluid_;
  std::vector<linear::Vector> velocity_, next_,
      begun_;  ///< begun: the velocity before a step of two stages
  std::optional<linear::Vector> smoke_, heat_, heldSmoke_, heldHeat_, sourceWeight_;
  std::optional<linear::Vector> there_, back_, change_;
  linear::Vector inflow_;
  std::vector<linear::Vector> pressure_;  ///< of each stage
  std::unique_ptr<linear::Matrix> matrix_;
  std::unique_ptr<linear::Preconditioner> preconditioner_;
  std::unique_ptr<linear::Method> method_;
  std::vector<std::unique_ptr<ViscousMatrix>> viscous_;
  std::vector<std::unique_ptr<linear::Method>> diffusion_;
  double time_ = 0.0;
  std::int64_t steps_ = 0;
};

}  // namespace fluid
