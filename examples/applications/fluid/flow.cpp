// SPDX-License-Identifier: MIT
#include "flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "momentum.sk.hpp"
#include "pressure.sk.hpp"
#include "support/named.hpp"
#include "transport.sk.hpp"
#include "vectors.sk.hpp"

namespace fluid {

namespace {

sk::Storage storageFor(sk::Precision precision) {
  switch (precision) {
    case sk::Precision::Half: return sk::Storage::Half;
    case sk::Precision::Default:
    case sk::Precision::Single: return sk::Storage::Single;
    case sk::Precision::Extended: return sk::Storage::Extended;
    case sk::Precision::Double: return sk::Storage::Double;
  }
  return sk::Storage::Single;
}

linear::Arithmetic arithmeticFor(sk::Precision precision, bool isDivided) {
  const sk::Storage storage = storageFor(precision);
  return {.precision = precision,
          .matrix = storage,
          .vectors = storage,
          .accumulate = isDivided ? sk::Accumulate::Exact : sk::Accumulate::Default};
}

/// Calls f with the kernel of an axis.
template <class F, class A, class B, class C>
void forAxis(int axis, F&& f, const A& a, const B& b, const C& c) {
  if (axis == 0) f(a);
  if (axis == 1) f(b);
  if (axis == 2) f(c);
}

constexpr const char* velocityNames[] = {"u", "v", "w"};
constexpr sk::CallOptions inDouble{.precision = sk::Precision::Double};
constexpr std::int64_t iterationsBetweenLooks = 8;
constexpr std::int64_t cyclesBetweenLooks = 1;  ///< a cycle costs more than a look

/// What sources hold, and how much of a cell they cover.
struct Held {
  std::vector<double> weight, smoke, heat;
};

Held heldBy(const Model& m) {
  Held held;
  const sk::Shape shape = m.shape();
  const bool layerZ = !m.isPeriodic(2), layerY = !m.isPeriodic(1), layerX = !m.isPeriodic(0);
  for (std::int64_t z = 0; z < shape[0]; ++z) {
    for (std::int64_t y = 0; y < shape[1]; ++y) {
      for (std::int64_t x = 0; x < shape[2]; ++x) {
        const Triple p = m.centre({x, y, z});
        double weight = 0.0, smoke = 0.0, heat = 0.0;
        for (const Source& source : m.sources) {
          const double part = std::clamp(0.5 - source.shape.distance(p, m.isSpace()) / m.spacing, 0.0, 1.0);
          if (part <= weight) continue;
          weight = part;
          smoke = source.smoke;
          heat = source.temperature;
        }
        const bool isLayer = (layerX && (x == 0 || x > m.cells[0])) ||
                             (layerY && (y == 0 || y > m.cells[1])) || (layerZ && (z == 0 || z > m.cells[2]));
        held.weight.push_back(isLayer ? 0.0 : weight);
        held.smoke.push_back(smoke);
        held.heat.push_back(heat);
      }
    }
  }
  return held;
}

}  // namespace

Flow::Flow(sk::Device& device, const Model& model, const Triple& inside)
    : Flow(linear::Space(device, model.shape()), model, inside) {}

Flow::Flow(const linear::Space& space, const Model& model, const Triple& inside)
    : model_(model),
      arithmetic_(arithmeticFor(model.precision, space.isDivided())),
      options_(arithmetic_.options()),
      grid_(std::make_unique<GridArguments>(space, model_)),
      inflow_(makeStream()) {
  if (const std::string wrong = contradiction(model); !wrong.empty())
    throw std::runtime_error(fmt::format("the flow {}", wrong));
  sk::Device& device = space.device();
  const std::vector<std::int8_t> cells = cellsOf(model);
  fluid_ = fluidCells(cells);
  const bool hasStages = model.scheme == Scheme::Central;
  for (int axis = 0; axis < model.rank(); ++axis) {
    velocity_.push_back(makeStream());
    next_.push_back(makeStream());
    if (hasStages) begun_.push_back(makeStream());
    velocity_.back().writeReals(givenVelocity(model, axis, inside));
  }
  for (int stage = 0; stage < (hasStages ? 2 : 1); ++stage) {
    pressure_.push_back(makeStream());
    pressure_.back().fill(0.0f);
  }
  matrix_ = makePressureMatrix(*grid_, arithmetic_);
  if (model.projector == Projector::Multigrid) {
    preconditioner_ = makePressureMultigrid(space, model, cells, arithmetic_);
  } else {
    const auto& kind = examples::rowNamed(linear::preconditionerKinds(), "chebyshev", "preconditioner");
    preconditioner_ = kind.make(device, *matrix_, pressureOperator(model, cells), arithmetic_);
  }
  const auto& gradients = examples::rowNamed(linear::methodKinds(), "cg", "solver");
  method_ = gradients.make(device, *matrix_, preconditioner_.get(), arithmetic_);

  const auto start = [&](std::optional<linear::Vector>& stream, double value) {
    stream.emplace(makeStream());
    stream->writeReals(std::vector<double>(cells.size(), value));
  };
  if (model.hasSmoke) start(smoke_, 0.0);
  if (model.hasHeat) start(heat_, model.buoyancy ? model.buoyancy->ambient : 0.0);
  if (!model.sources.empty()) {
    const Held held = heldBy(model);
    sourceWeight_.emplace(makeStream());
    sourceWeight_->writeReals(held.weight);
    if (smoke_) heldSmoke_.emplace(makeStream()), heldSmoke_->writeReals(held.smoke);
    if (heat_) heldHeat_.emplace(makeStream()), heldHeat_->writeReals(held.heat);
  }
  const bool corrects = model.scheme != Scheme::SemiLagrangian;
  const bool transports = model.scheme != Scheme::Central || model.hasSmoke || model.hasHeat;
  if (transports && corrects) {
    there_.emplace(makeStream());
    back_.emplace(makeStream());
  }
  if (model.viscosity && model.viscosity->isImplicit) {
    change_.emplace(makeStream());
    for (int axis = 0; axis < model.rank(); ++axis) {
      viscous_.push_back(std::make_unique<ViscousMatrix>(*grid_, axis, arithmetic_));
      diffusion_.push_back(gradients.make(device, *viscous_.back(), nullptr, arithmetic_));
    }
  }
}

linear::Vector& Flow::stream(Scalar scalar) {
  auto& place = scalar == Scalar::Smoke ? smoke_ : heat_;
  if (!place)
    throw std::logic_error(scalar == Scalar::Smoke ? "the scene has no smoke" : "the scene has no heat");
  return *place;
}

sk::Optional<sk::In<float>> Flow::along(int axis) const {
  if (axis < model_.rank()) return velocity_[at(axis)];
  return sk::none;
}

int Flow::streams() const {
  const auto count = [](const auto&... optional) { return (0 + ... + (optional.has_value() ? 1 : 0)); };
  return static_cast<int>(velocity_.size() + next_.size() + begun_.size() + pressure_.size()) + 1 +
         count(smoke_, heat_, heldSmoke_, heldHeat_, sourceWeight_, there_, back_, change_) +
         (grid_->bounds == Anywhere ? 2 : 0);  // cells and their faces
}

int Flow::streamsOf(const Model& m) {
  const bool isCentral = m.scheme == Scheme::Central;
  const bool corrects = m.scheme != Scheme::SemiLagrangian && (!isCentral || m.hasSmoke || m.hasHeat);
  const int scalars = (m.hasSmoke ? 1 : 0) + (m.hasHeat ? 1 : 0);
  return m.rank() * (isCentral ? 3 : 2) + (isCentral ? 2 : 1) + 1 + scalars +
         (m.sources.empty() ? 0 : 1 + scalars) + (corrects ? 2 : 0) +
         (m.viscosity && m.viscosity->isImplicit ? 1 : 0) + (m.bounds() == Anywhere ? 2 : 0);
}

// ---- a step ------------------------------------------------------------------------------------------------

double Flow::surveyOne(const linear::Vector& stream, const char* name) {
  const auto [most, broken] = survey.with(options_)(stream);
  if (broken == std::numeric_limits<int>::max()) return most;
  const std::int64_t w = space().shape()[2], h = space().shape()[1];
  const std::int64_t x = broken % w, y = broken / w % h, z = broken / (w * h);
  const std::string cell =
      model_.isSpace() ? fmt::format("({}, {}, {})", x, y, z) : fmt::format("({}, {})", x, y);
  throw std::runtime_error(
      fmt::format("step {}: {} is not finite in cell {}; take a smaller time step, or a scheme other than "
                  "central differences",
                  steps_, name, cell));
}

double Flow::surveyed() {
  double speed = 0.0;
  for (int axis = 0; axis < model_.rank(); ++axis)
    speed = std::max(speed, surveyOne(velocity_[at(axis)], velocityNames[axis]));
  if (smoke_) surveyOne(*smoke_, "smoke");
  if (heat_) surveyOne(*heat_, "heat");
  return speed;
}

double Flow::chosenTimeStep(double speed) const {
  if (model_.timeStep) return *model_.timeStep;
  double acceleration = 0.0;
  for (const double f : model_.force) acceleration = std::max(acceleration, std::abs(f));
  if (model_.buoyancy) {
    for (const Source& s : model_.sources)
      acceleration = std::max(acceleration,
                              std::abs(model_.buoyancy->lift * (s.temperature - model_.buoyancy->ambient)) +
                                  std::abs(model_.buoyancy->sink * s.smoke));
  }
  // A flow that begins at rest is as fast, after a step, as its forces make it.
  double scale = std::max(speed, std::sqrt(acceleration * model_.spacing));
  if (scale == 0.0) scale = 1.0;
  double dt = model_.cfl * model_.spacing / scale;
  if (model_.viscosity && !model_.viscosity->isImplicit)
    dt =
        std::min(dt, 0.9 * model_.spacing * model_.spacing / (2.0 * model_.rank() * model_.viscosity->value));
  return dt;
}

Step Flow::step(double longest) {
  Step report;
  report.speed = surveyed();
  report.timeStep = std::min(chosenTimeStep(report.speed), longest);
  const double dt = report.timeStep;
  report.cfl = report.speed * dt / model_.spacing;
  checkCarried(report.cfl);
  holdSources();
  const bool acts =
      model_.buoyancy || (model_.viscosity && !model_.viscosity->isImplicit) || model_.force != Triple{};
  if (model_.scheme == Scheme::Central) {
    for (int axis = 0; axis < model_.rank(); ++axis) velocity_[at(axis)].copyTo(begun_[at(axis)]);
    transport(dt);
    accelerate(dt, true, 0.0);
    const Projection first = project(0, report.speed);
    accelerate(dt, true, 0.5);
    report.projection = project(1, report.speed);
    report.projection.iterations += first.iterations;
    report.projection.reached &= first.reached;
  } else {
    transport(dt);
    if (acts) accelerate(dt, false, 0.0);
    if (!diffusion_.empty()) diffuse(dt, report.speed);
    report.projection = project(0, report.speed);
  }
  time_ += dt;
  ++steps_;
  return report;
}

void Flow::checkCarried(double cells) const {
  if (!space().isDivided() || cells <= farthestCarried) return;
  throw std::runtime_error(fmt::format(
      "step {}: the velocity carries up to {:.3g} cells in a step, and a flow that is divided over "
      "ranks at most {:g}; take a smaller time step, or one process",
      steps_, cells, farthestCarried));
}

void Flow::holdSources() {
  if (heldSmoke_) hold.with(options_)(*sourceWeight_, *heldSmoke_, *smoke_, *smoke_);
  if (heldHeat_) hold.with(options_)(*sourceWeight_, *heldHeat_, *heat_, *heat_);
}

/// Scalars first: all of them go with the velocity before the step.
void Flow::transport(double dt) {
  const double step = dt / model_.spacing;
  for (auto* scalar : {&smoke_, &heat_}) {
    if (!*scalar) continue;
    carryOne(3, step, **scalar, inflow_);
    std::swap(**scalar, inflow_);
  }
  if (model_.scheme == Scheme::Central) return;
  for (int axis = 0; axis < model_.rank(); ++axis) carryOne(axis, step, velocity_[at(axis)], next_[at(axis)]);
  std::swap(velocity_, next_);
}

void Flow::carryOne(int axis, double step, const linear::Vector& from, linear::Vector& to) {
  const auto call = [&](const auto& f) {
    if (axis == 3)
      f(carry_3, correct_3);
    else if (axis == 0)
      f(carry_0, correct_0);
    else if (axis == 1)
      f(carry_1, correct_1);
    else
      f(carry_2, correct_2);
  };
  // Paths end inside of the grid: scalars at centres, so that nothing of the layer comes in.
  const float margin = axis == 3 ? 1.0f : 0.5f;
  Carrier c{static_cast<float>(step), 2, {}, {}};
  const auto ends = [&](int d, float& low, float& high) {
    low = model_.isPeriodic(d) ? -1e6f : margin;
    high = model_.isPeriodic(d) ? 1e6f : static_cast<float>(model_.cells[at(d)]) + 1.0f - margin;
  };
  ends(0, c.low.x, c.high.x);
  ends(1, c.low.y, c.high.y);
  ends(2, c.low.z, c.high.z);
  Carrier back = c;
  back.step = -c.step;
  const auto along = [&](const Carrier& carrier) {
    Paths paths{.carrier = carrier, .u = velocity_[0], .v = velocity_[1]};
    if (model_.isSpace()) paths.w = velocity_[2];
    return paths;
  };
  const Grid grid = grid_->grid();
  call([&](const auto& carry, const auto& correct) {
    if (model_.scheme == Scheme::SemiLagrangian) {
      carry.with(options_)(grid, along(c), from, to);
      return;
    }
    carry.with(options_)(grid, along(c), from, *there_);
    carry.with(options_)(grid, along(back), *there_, *back_);
    correct.with(options_)(grid, along(c), model_.scheme == Scheme::Bfecc, from, *there_, *back_, to);
  });
}

void Flow::accelerate(double dt, bool convects, double keep) {
  const bool isViscous = model_.viscosity && !model_.viscosity->isImplicit;
  const bool isHeated = model_.buoyancy && heat_ && model_.buoyancy->lift != 0.0;
  const bool isLaden = model_.buoyancy && smoke_ && model_.buoyancy->sink != 0.0;
  for (int axis = 0; axis < model_.rank(); ++axis) {
    Motion m{};
    m.convection = static_cast<float>(dt / model_.spacing);
    if (isViscous)
      m.viscosity = static_cast<float>(model_.viscosity->value * dt / (model_.spacing * model_.spacing));
    m.force = static_cast<float>(dt * model_.force[at(axis)]);
    const bool isUp = axis == 1;
    if (isHeated && isUp) {
      m.lift = static_cast<float>(dt * model_.buoyancy->lift);
      m.ambient = static_cast<float>(model_.buoyancy->ambient);
    }
    if (isLaden && isUp) m.sink = static_cast<float>(dt * model_.buoyancy->sink);
    m.keep = static_cast<float>(keep);
    Forces forces{.convects = convects,
                  .isViscous = isViscous,
                  .isHeated = isHeated && isUp,
                  .isLaden = isLaden && isUp,
                  .motion = m};
    if (isHeated && isUp) forces.heat = *heat_;
    if (isLaden && isUp) forces.smoke = *smoke_;
    const linear::Vector& base = keep != 0.0 ? begun_[at(axis)] : velocity_[at(axis)];
    const auto call = [&](const auto& kernel) {
      kernel.with(options_)(grid_->grid(), forces, velocity_[at(axis)], along((axis + 1) % 3),
                            along((axis + 2) % 3), base, next_[at(axis)]);
    };
    forAxis(axis, call, accelerate_0, accelerate_1, accelerate_2);
  }
  std::swap(velocity_, next_);
}

/// Backward Euler for the change: (1 - c Laplacian) change = c Laplacian of the velocity.
void Flow::diffuse(double dt, double speed) {
  const double c = model_.viscosity->value * dt / (model_.spacing * model_.spacing);
  Motion m{};
  m.viscosity = static_cast<float>(c);
  const double small = 0.1 * model_.tolerance * std::max(speed, 1e-30);
  for (int axis = 0; axis < model_.rank(); ++axis) {
    linear::Vector& v = velocity_[at(axis)];
    const auto call = [&](const auto& kernel) {
      const Forces forces{
          .convects = false, .isViscous = true, .isHeated = false, .isLaden = false, .motion = m};
      kernel.with(options_)(grid_->grid(), forces, v, sk::none, sk::none, v, *change_);
    };
    forAxis(axis, call, accelerate_0, accelerate_1, accelerate_2);
    linear::axpy.with(options_)(-1.0f, v, *change_, *change_);
    viscous_[at(axis)]->setCoefficient(c);
    linear::Method& method = *diffusion_[at(axis)];
    method.begin(*change_, small * small * static_cast<double>(fluid_));
    method.run(iterationsBetweenLooks, model_.mostIterations);
    linear::axpy.with(options_)(1.0f, method.x(), v, v);
  }
}

void Flow::subtract(const linear::Vector& q) {
  if (model_.isSpace())
    subtractSlopes.with(options_)(grid_->grid(), q, velocity_[0], velocity_[1], velocity_[2], velocity_[0],
                                  velocity_[1], velocity_[2]);
  else
    subtractSlopes.with(options_)(grid_->grid(), q, velocity_[0], velocity_[1], sk::none, velocity_[0],
                                  velocity_[1], sk::none);
}

std::pair<double, double> Flow::measureInflows() {
  inflows.with(options_)(grid_->grid(), velocity_[0], velocity_[1], along(2), inflow_);
  const auto [most, squares] = magnitudes.with(arithmetic_.foldOptions())(inflow_);
  return {most, squares};
}

/// Behind walls without friction and outflows; nothing is done in a model that has neither.
void Flow::extendVelocity() {
  const auto isOpen = [](Side side) { return side == Side::Slip || side == Side::Outflow; };
  if (std::ranges::none_of(model_.sides, isOpen)) return;
  for (int axis = 0; axis < model_.rank(); ++axis) {
    linear::Vector& v = velocity_[at(axis)];
    const auto call = [&](const auto& kernel) { kernel.with(options_)(grid_->box, v, v); };
    forAxis(axis, call, extend_0, extend_1, extend_2);
  }
}

/// From the pressure of the step before, and then what is left of the divergence.
Projection Flow::project(std::size_t stage, double speed) {
  Projection report;
  auto [most, squares] = measureInflows();
  report.before = most / model_.spacing;
  const double scale = std::max({speed, most, 1e-30});
  const auto cells = static_cast<double>(fluid_);
  const double limit = model_.tolerance * model_.tolerance * scale * scale * cells;
  if (squares > limit) {
    subtract(pressure_[stage]);
    std::tie(most, squares) = measureInflows();
  }
  report.recurred = std::sqrt(squares / cells) / scale;
  if (squares > limit) {
    // A little below, so that rounding the velocities does not miss it.
    method_->begin(inflow_, 0.8 * limit);
    const bool isMultigrid = model_.projector == Projector::Multigrid;
    report.iterations =
        method_->run(isMultigrid ? cyclesBetweenLooks : iterationsBetweenLooks, model_.mostIterations);
    report.recurred = std::sqrt(std::abs(method_->residualSquared()) / cells) / scale;
    subtract(method_->x());
    linear::axpy.with(options_)(1.0f, method_->x(), pressure_[stage], pressure_[stage]);
    std::tie(most, squares) = measureInflows();
  }
  extendVelocity();
  report.after = most / model_.spacing;
  report.residual = std::sqrt(squares / cells) / scale;
  report.reached = report.residual <= model_.tolerance;
  return report;
}

// ---- what there is ------------------------------------------------------------------------------------------

std::vector<double> Flow::exactDivergence() {
  linear::Vector exact = space().stream<float>(sk::Storage::Double);
  inflows.with(inDouble)(grid_->grid(), velocity_[0], velocity_[1], along(2), exact);
  return exact.readReals();
}

double Flow::divergence() {
  double most = 0.0;
  for (const double d : exactDivergence()) most = std::max(most, std::abs(d));
  return most / model_.spacing;
}

double Flow::divergenceMean() {
  double sum = 0.0;
  for (const double d : exactDivergence()) sum += d * d;
  return std::sqrt(sum / static_cast<double>(fluid_));
}

double Flow::kineticEnergy() const {
  double sum = 0.0;
  for (int axis = 0; axis < model_.rank(); ++axis) {
    const auto call = [&](const auto& reduce) {
      sum += reduce.with(arithmetic_.foldOptions())(grid_->grid(), velocity_[at(axis)]);
    };
    forAxis(axis, call, squares_0, squares_1, squares_2);
  }
  return 0.5 * sum * std::pow(model_.spacing, model_.rank());
}

double Flow::total(Scalar scalar) {
  return fluid::total.with(arithmetic_.foldOptions())(stream(scalar)) *
         std::pow(model_.spacing, model_.rank());
}

std::pair<double, double> Flow::range(Scalar scalar) {
  const std::vector<double> all = values(scalar);
  if (all.empty()) return {};
  const auto [low, high] = std::ranges::minmax_element(all);
  return {*low, *high};
}

}  // namespace fluid
