// SPDX-License-Identifier: MIT
#include "flow.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "equations.hpp"
#include "layout.hpp"
#include "named.hpp"
#include "preconditioner.hpp"
#include "residual.hpp"
#include "solve.hpp"

namespace smooth {

/// The equations on the device, with all that solving them needs. The places of the entries are those of the first step, and so are the streams and the
/// recorded iteration: a step writes the values alone.
class Flow::Solver {
 public:
  Solver(sk::Device& device, const Surface& surface, const Faults& faults, const FlowSettings& settings)
      : equations_(surface), settings_(settings) {
    computeValues(surface, faults);
    matrix_ = linear::makeMatrix(device, linear::scaled(equations_.matrix(), a_.scale), settings.layout,
                                 arithmetic_);
    preconditioner_ = linear::rowNamed(linear::preconditionerKinds(), "jacobi", "preconditioner")
                          .make(device, *matrix_, a_, arithmetic_);
    method_ = linear::rowNamed(linear::methodKinds(), "cg", "solver")
                  .make(device, *matrix_, preconditioner_.get(), arithmetic_);
    residual_ = linear::makeResidual(device, *matrix_, a_, arithmetic_);
  }

  /// For other positions of the points.
  void update(const Surface& surface, const Faults& faults) {
    computeValues(surface, faults);
    matrix_->update(linear::scaled(equations_.matrix(), a_.scale));
    preconditioner_->update(a_);
    residual_->update();
  }

  /// By how much one coordinate of all points changes in the step.
  linear::Solution changeOf(std::span<const double> x) {
    // For the change of x, so that the tolerance is that of the change.
    std::vector<double> b = linear::multiply(equations_.laplacian(), x);
    for (double& v : b) v = -v;
    return linear::solve(*method_, *residual_, a_, b, arithmetic_, {.tolerance = settings_.tolerance});
  }

  std::string layout() const { return matrix_->layout(); }

 private:
  void computeValues(const Surface& surface, const Faults& faults) {
    equations_.update(surface, faults, settings_.timeStep, settings_.fixesBoundary);
    a_ = linear::operatorOf(equations_.matrix());
  }

  Equations equations_;
  FlowSettings settings_;
  linear::Arithmetic arithmetic_;
  linear::Operator a_;
  std::unique_ptr<linear::Matrix> matrix_;
  std::unique_ptr<linear::Preconditioner> preconditioner_;
  std::unique_ptr<linear::Method> method_;
  std::unique_ptr<linear::Residual> residual_;
};

Flow::~Flow() = default;
Flow::Flow(Flow&&) noexcept = default;

Flow::Flow(sk::Device& device, Surface surface, const FlowSettings& settings)
    : device_(device),
      surface_(std::move(surface)),
      settings_(settings),
      faults_(inspect(surface_)),
      layout_(settings.layout),
      volume_(volumeOf(surface_)) {
  if (faults_.degenerate.size() == surface_.faces.size())
    throw std::runtime_error("the surface has no triangle with an area; nothing can flow");
  if (settings_.keepsVolume && (!faults_.isClosed || !(std::abs(volume_) > 0.0)))
    throw std::runtime_error(
        "the surface is open, or encloses nothing, and has no volume to keep; take keep_volume = false");
}

StepReport Flow::step() {
  ++steps_;
  if (solver_)
    solver_->update(surface_, faults_);
  else
    solver_ = std::make_unique<Solver>(device_, surface_, faults_, settings_);
  layout_ = solver_->layout();
  StepReport report;
  for (double Vector::* const component : {&Vector::x, &Vector::y, &Vector::z}) {
    std::vector<double> x;
    for (const Vector& p : surface_.points) x.push_back(p.*component);
    const linear::Solution change = solver_->changeOf(x);
    if (change.outcome != linear::Outcome::Converged)
      throw std::runtime_error(
          fmt::format("step {}: the equations were not solved: {}, residual {:.2g}; take a smaller time step",
                      steps_, linear::nameOf(change.outcome), change.residualTrue));
    for (std::size_t i = 0; i < x.size(); ++i) surface_.points[i].*component += change.x[i];
    report.iterations += change.iterations;
    report.residual = std::max(report.residual, change.residualTrue);
    report.secondsSolving += change.seconds;
  }
  inspectAreas(surface_, faults_);
  if (settings_.keepsVolume) restoreVolume();
  report.volume = volumeOf(surface_);
  report.area = areaOf(surface_);
  return report;
}

void Flow::restoreVolume() {
  const double factor = std::cbrt(volume_ / volumeOf(surface_));
  const Vector centre = centreOf(surface_);
  for (Vector& p : surface_.points) p = centre + factor * (p - centre);
}

}  // namespace smooth
