// SPDX-License-Identifier: MIT
#include "surface.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "support/named.hpp"
#include "surface.sk.hpp"
#include "vectors.sk.hpp"

namespace waves {

namespace {

constexpr std::int64_t iterationsBetweenLooks = 2;

linear::Arithmetic arithmeticFor(sk::Precision precision, bool isDivided) {
  const sk::Storage storage = precision == sk::Precision::Double ? sk::Storage::Double : sk::Storage::Single;
  return {.precision = precision,
          .matrix = storage,
          .vectors = storage,
          .accumulate = isDivided ? sk::Accumulate::Exact : sk::Accumulate::Default};
}

sk::Shape shapeOf(const Model& model) { return {model.height, model.width}; }

class WaveMatrix : public linear::Matrix {
 public:
  WaveMatrix(const linear::Space& space, const Model& model, const linear::Arithmetic& arithmetic)
      : Matrix(arithmetic), space_(space), k_(static_cast<float>(model.coefficient())) {}
  sk::Shape domain() const override { return space_.shape(); }
  linear::Space space(sk::Device&) const override { return space_; }
  void multiply(const linear::Vector& x, linear::Vector& y) override {
    waveProduct.with(options())(k_, x, y);
  }
  void multiply(const linear::Vector& x, linear::Vector& y, linear::Vector& xy) override {
    waveProductDot.with(foldOptions())(k_, x, y, xy);
  }
  std::string layout() const override { return "stencil"; }
  std::int64_t stored() const override { return 0; }
  std::int64_t bytes() const override { return 0; }

 private:
  linear::Space space_;
  float k_;
};

void requirePositive(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw std::runtime_error(fmt::format("the {} of a surface is {}; it must be positive", name, value));
}

/// Calls visit(i, j) for each pair of cells side by side.
template <class Visit>
void visitPairs(std::int64_t width, std::int64_t height, Visit&& visit) {
  for (std::int64_t y = 0; y < height; ++y)
    for (std::int64_t x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y * width + x);
      if (x + 1 < width) visit(i, i + 1);
      if (y + 1 < height) visit(i, i + static_cast<std::size_t>(width));
    }
}

}  // namespace

double Model::lambdaSquared() const {
  const double lambda = speed * timeStep / spacing;
  return static_cast<double>(static_cast<float>(lambda * lambda));
}

double Model::roundoff() const { return precision == sk::Precision::Double ? 0x1p-53 : 0x1p-24; }

Surface::Surface(sk::Device& device, const Model& model)
    : Surface(linear::Space(device, shapeOf(model)), model) {}

Surface::Surface(const linear::Space& space, const Model& model)
    : space_(space),
      model_(model),
      arithmetic_(arithmeticFor(model.precision, space.isDivided())),
      sum_(space.device().stream<float>({1}, arithmetic_.sums())) {
  requirePositive("width", static_cast<double>(model.width));
  requirePositive("height", static_cast<double>(model.height));
  requirePositive("spacing", model.spacing);
  requirePositive("wave speed", model.speed);
  requirePositive("time step", model.timeStep);
  requirePositive("tolerance", model.tolerance);
  for (linear::Vector* s : {&u_, &q_, &un_, &qn_, &b_, &w_, &change_, &r_}) {
    *s = stream();
    s->fill(0.0f);
  }
  matrix_ = std::make_unique<WaveMatrix>(space_, model_, arithmetic_);
  method_ = examples::rowNamed(linear::methodKinds(), "cg", "solver")
                .make(space_.device(), *matrix_, nullptr, arithmetic_);
}

void Surface::writeHeights(std::span<const double> values) {
  u_.writeReals(values);
  change_.fill(0.0f);  // says nothing of another surface
}

void Surface::writeVelocities(std::span<const double> values) {
  std::vector<double> q(values.begin(), values.end());
  for (double& v : q) v *= model_.timeStep;
  q_.writeReals(q);
  change_.fill(0.0f);
}

std::vector<double> Surface::velocities() const {
  std::vector<double> v = q_.readReals();
  for (double& value : v) value /= model_.timeStep;
  return v;
}

Step Surface::step() {
  const sk::CallOptions fold = arithmetic_.foldOptions();
  const auto theta = static_cast<float>(model_.theta()), k = static_cast<float>(model_.coefficient());
  predict.with(fold)(theta, u_, q_, change_, b_, w_, sum_);
  const double bb = sum_.readReals()[0];
  if (!std::isfinite(bb))
    throw std::runtime_error(
        fmt::format("step {}: the surface is not finite, or too high for its precision", steps_ + 1));
  Step step;
  step.length = std::sqrt(bb);
  const double limit = std::max(model_.tolerance, model_.attainable()) * step.length;
  residualOf.with(fold)(k, b_, w_, r_, sum_);
  if (sum_.readReals()[0] > 0.25 * limit * limit) {
    // Half of the tolerance, so that rounding w does not miss it.
    method_->begin(r_, 0.25 * limit * limit);
    step.iterations = method_->run(iterationsBetweenLooks, model_.mostIterations);
    linear::axpy.with(arithmetic_.options())(1.0f, method_->x(), w_, w_);
  }
  advance.with(fold)(theta, static_cast<float>(model_.lambdaSquared()), k, w_, b_, u_, q_, un_, qn_, change_,
                     sum_);
  const double left = sum_.readReals()[0];
  std::swap(u_, un_);
  std::swap(q_, qn_);
  ++steps_;
  if (!std::isfinite(left))
    throw std::runtime_error(
        fmt::format("step {}: the surface is not finite, or too high for its precision", steps_));
  step.residual = step.length > 0.0 ? std::sqrt(left) / step.length : 0.0;
  step.reached = std::sqrt(left) <= limit;
  return step;
}

double Surface::energy() const {
  const std::vector<double> u = u_.readReals(), q = q_.readReals();
  if (u.empty()) return 0.0;
  double kinetic = 0.0, potential = 0.0;
  for (const double v : q) kinetic += v * v;
  visitPairs(model_.width, model_.height,
             [&](std::size_t i, std::size_t j) { potential += (u[j] - u[i]) * (u[j] - u[i]); });
  const double scale = model_.spacing / model_.timeStep;
  return 0.5 * scale * scale * (kinetic + model_.lambdaSquared() * potential);
}

double Surface::energyBound(const Step& step, double energy) const {
  const double scale = model_.spacing / model_.timeStep, lambda = std::sqrt(model_.lambdaSquared());
  const double root = std::sqrt(energy) / scale;  // of the energy in the units of q
  const double residual = step.residual * step.length, rounding = model_.roundoff() * step.length;
  const double change = 8.0 * lambda * root * (residual + 2.0 * (1.0 + lambda) * rounding) +
                        4.0 * model_.roundoff() * root * root;
  return scale * scale * change;
}

double Surface::residualInDouble() const {
  const std::vector<double> b = b_.readReals(), w = w_.readReals();
  if (b.empty()) return 0.0;
  std::vector<double> r(b.size());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - w[i];
  const double k = model_.coefficient();
  visitPairs(model_.width, model_.height, [&](std::size_t i, std::size_t j) {
    r[i] -= k * (w[i] - w[j]);
    r[j] -= k * (w[j] - w[i]);
  });
  double rr = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    rr += r[i] * r[i];
    bb += b[i] * b[i];
  }
  return bb > 0.0 ? std::sqrt(rr / bb) : 0.0;
}

}  // namespace waves
