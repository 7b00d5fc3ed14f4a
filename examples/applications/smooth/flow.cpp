// SPDX-License-Identifier: MIT
#include "flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "equations.hpp"
#include "layout.hpp"
#include "preconditioner.hpp"
#include "residual.hpp"
#include "solve.hpp"
#include "support/named.hpp"

namespace smooth {

namespace {

constexpr std::array<std::string_view, 4> precisions = {"auto", "single", "extended", "double"};

linear::Arithmetic arithmeticNamed(std::string_view precision) {
  if (precision == "extended")
    return {.precision = sk::Precision::Extended,
            .matrix = sk::Storage::Extended,
            .vectors = sk::Storage::Extended};
  return precision == "double" ? linear::doubleArithmetic() : linear::Arithmetic();
}

/// What the matrix needs. Rounding its entries to floats, and each product with them, moves eigenvalues after Jacobi's scaling by up to 2^-24 times the largest, which
/// jacobiBound bounds; sixteen times as much must leave the least positive.
std::string_view neededPrecision(sk::Device& device, const linear::Operator& a, double leastEigenvalue) {
  if (leastEigenvalue >= 16.0 * 0x1p-24 * a.jacobiBound) return "single";
  return linear::hasDoubles(device) ? "double" : "extended";
}

void checkPrecision(std::string_view name) {
  if (std::ranges::find(precisions, name) != precisions.end()) return;
  throw std::runtime_error(
      fmt::format("no precision is called '{}'; there are {}", name, fmt::join(precisions, ", ")));
}

}  // namespace

/// The equations on the device, with all that solving them needs. The places of the entries are those of the first step, and so are the streams and the
/// recorded iteration: a step writes the values alone, unless they need more precision than those before.
class Flow::Solver {
 public:
  Solver(sk::Device& device, const Surface& surface, const Faults& faults, const FlowSettings& settings)
      : device_(device), equations_(surface), settings_(settings) {
    computeValues(surface, faults);
    make(settings.precision == "auto" ? std::string(neededPrecision(device, a_, equations_.leastEigenvalue()))
                                      : settings.precision,
         cheapest);
  }

  /// For other positions of the points.
  void update(const Surface& surface, const Faults& faults) {
    computeValues(surface, faults);
    if (mayNeedMore()) {
      const std::string_view needed = neededPrecision(device_, a_, equations_.leastEigenvalue());
      if (needed != "single") return make(std::string(needed), preconditionedBy_);
    }
    if (preconditionedBy_ != cheapest) return make(precision_, preconditionedBy_);
    matrix_->update(linear::scaled(balanced_, a_.scale));
    preconditioner_->update(a_);
    residual_->update();
  }

  /// By how much one coordinate of all points changes in the step.
  linear::Solution changeOf(std::span<const double> x) {
    // For the change of x, so that the tolerance is that of the change.
    std::vector<double> b = linear::multiply(equations_.laplacian(), x);
    for (std::size_t i = 0; i < b.size(); ++i) b[i] *= -scale_[i];
    linear::Solution change = solve(b);
    if (!isSolved(change) && mayNeedMore()) {
      make(linear::hasDoubles(device_) ? "double" : "extended", preconditionedBy_);
      change = solve(b);
    }
    if (!isSolved(change) && preconditionedBy_ != strongest) {
      make(precision_, strongest);
      change = solve(b);
    }
    for (std::size_t i = 0; i < change.x.size(); ++i) change.x[i] *= scale_[i];
    // Steps so long that M is lost beside dt L: any constant solves these equations.
    if (equations_.largestMass() < 0x1p-40) equations_.keepCentres(change.x);
    return change;
  }

  static bool isSolved(const linear::Solution& change) {
    return change.outcome == linear::Outcome::Converged ||
           change.outcome == linear::Outcome::SingularAndCompatible || isAsExactAsDoubles(change);
  }

  /// x solves equations whose entries differ from these by less than their own rounding errors (J. Rigal and J. Gaches, "On the compatibility of a given solution with
  /// the data of a linear system", 1967). Where a surface has almost shrunk to curves, condition numbers exceed 10^8, and no double x has a residual below the tolerance.
  static bool isAsExactAsDoubles(const linear::Solution& change) {
    return (change.outcome == linear::Outcome::Stagnated ||
            change.outcome == linear::Outcome::MostIterations) &&
           change.backwardError <= mostBackwardError;
  }

  std::string layout() const { return matrix_->layout(); }
  const std::string& precision() const { return precision_; }
  std::string_view preconditioner() const { return preconditionedBy_; }

 private:
  /// Preconditioners: one that follows other values of the matrix, and one that is made anew for each step. The second is for surfaces
  /// that have almost shrunk to curves: with the first, iterations are as many as points, and lose what they gain to rounding.
  static constexpr std::string_view cheapest = "jacobi", strongest = "aggregation";

  void make(std::string precision, std::string_view preconditioner) {
    precision_ = std::move(precision);
    preconditionedBy_ = preconditioner;
    arithmetic_ = arithmeticNamed(precision_);
    residual_.reset();  // what refers to others goes first
    method_.reset();
    preconditioner_.reset();
    sk::Device& device = device_;
    matrix_ = linear::makeMatrix(device, linear::scaled(balanced_, a_.scale), settings_.layout, arithmetic_);
    preconditioner_ = examples::rowNamed(linear::preconditionerKinds(), preconditioner, "preconditioner")
                          .make(device, *matrix_, a_, arithmetic_);
    method_ = examples::rowNamed(linear::methodKinds(), "cg", "solver")
                  .make(device, *matrix_, preconditioner_.get(), arithmetic_);
    residual_ = linear::makeResidual(device, *matrix_, a_, arithmetic_);
  }

  bool mayNeedMore() const { return settings_.precision == "auto" && precision_ == "single"; }
  linear::Solution solve(std::span<const double> b) {
    const std::int64_t most =
        preconditionedBy_ == cheapest ? settings_.jacobiIterations : 10000 + 10 * a_.size;
    // With eigenvalues this small, the residual may be above that of x = 0 for as many iterations as there are points.
    return linear::solve(*method_, *residual_, a_, b, arithmetic_,
                         {.tolerance = settings_.tolerance, .most = most, .patience = a_.size});
  }

  void computeValues(const Surface& surface, const Faults& faults) {
    equations_.update(surface, faults, settings_.timeStep, settings_.fixesBoundary);
    balance();
    a_ = linear::operatorOf(balanced_);
  }

  /// Scales rows and columns by powers of two, which round nothing, so that all diagonal entries are about 1. Rows of slivers have entries billions of times as large as others, and their roundings would
  /// drown all other residuals.
  void balance() {
    balanced_ = equations_.matrix();
    scale_.clear();
    for (const double d : linear::diagonal(balanced_)) scale_.push_back(std::ldexp(1.0, -std::ilogb(d) / 2));
    for (std::size_t i = 0; i < scale_.size(); ++i)
      for (auto k = static_cast<std::size_t>(balanced_.starts[i]);
           k < static_cast<std::size_t>(balanced_.starts[i + 1]); ++k)
        balanced_.value[k] *= scale_[i] * scale_[static_cast<std::size_t>(balanced_.column[k])];
  }

  sk::Device& device_;
  Equations equations_;
  FlowSettings settings_;
  std::string precision_;
  std::string_view preconditionedBy_ = cheapest;
  linear::Arithmetic arithmetic_;
  linear::SparseMatrix balanced_;  ///< the matrix of the equations, scaled
  std::vector<double> scale_;
  linear::Operator a_;
  std::unique_ptr<linear::Matrix> matrix_;
  std::unique_ptr<linear::Preconditioner> preconditioner_;
  std::unique_ptr<linear::Method> method_;
  std::unique_ptr<linear::Residual> residual_;
};

std::span<const std::string_view> precisionNames() { return precisions; }

Flow::~Flow() = default;
Flow::Flow(Flow&&) noexcept = default;

Flow::Flow(sk::Device& device, Surface surface, const FlowSettings& settings)
    : device_(device),
      surface_(std::move(surface)),
      settings_(settings),
      faults_(inspect(surface_)),
      layout_(settings.layout),
      precision_(settings.precision),
      volume_(volumeOf(surface_)),
      area_(areaOf(surface_)) {
  checkPrecision(settings.precision);
  if (faults_.degenerate.size() == surface_.faces.size())
    throw std::runtime_error("the surface has no triangle with an area; nothing can flow");
  if (settings_.keepsVolume && (!faults_.isClosed || !(std::abs(volume_) > 0.0)))
    throw std::runtime_error(
        "the surface is open, or encloses nothing, and has no volume to keep; take keep_volume = false");
}

std::string_view Flow::preconditioner() const {
  return solver_ ? solver_->preconditioner() : std::string_view();
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
    if (!Solver::isSolved(change))
      throw std::runtime_error(fmt::format("step {}: the equations were not solved: {}, residual {:.2g}; {}",
                                           steps_, linear::nameOf(change.outcome), change.residualTrue,
                                           wayOut()));
    for (std::size_t i = 0; i < x.size(); ++i) surface_.points[i].*component += change.x[i];
    report.iterations += change.iterations;
    report.residual = std::max(report.residual, change.residualTrue);
    if (Solver::isAsExactAsDoubles(change))
      report.backwardError = std::max(report.backwardError, change.backwardError);
    report.secondsSolving += change.seconds;
  }
  precision_ = solver_->precision();
  inspectAreas(surface_, faults_);
  if (settings_.keepsVolume) restoreVolume();
  report.volume = volumeOf(surface_);
  report.area = areaOf(surface_);
  return report;
}

std::string Flow::wayOut() const {
  const double left = areaOf(surface_) / area_;
  // Weights of triangles along curves and across them then differ by more than doubles resolve.
  if (left < 0x1p-12)
    return fmt::format(
        "{:.2g} of the area is left: the surface has almost shrunk to curves or points; take fewer steps",
        left);
  return solver_->precision() == "single" ? "take a smaller time step, or the precision 'auto'"
                                          : "take a smaller time step";
}

void Flow::restoreVolume() {
  const double factor = std::cbrt(volume_ / volumeOf(surface_));
  if (!std::isfinite(factor))
    throw std::runtime_error(fmt::format(
        "step {}: the surface has no volume left that could be restored; take a smaller time step", steps_));
  const Vector centre = centreOf(surface_);
  for (Vector& p : surface_.points) p = centre + factor * (p - centre);
}

}  // namespace smooth
