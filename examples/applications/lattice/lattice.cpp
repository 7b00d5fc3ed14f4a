// SPDX-License-Identifier: MIT
#include "lattice.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "flow.sk.hpp"
#include "heat.sk.hpp"
#include "observe.sk.hpp"
#include "reaction.sk.hpp"

namespace examples {
namespace {

/// A configuration file may choose the storage of streams in single precision.
sk::Storage storageFor(sk::Precision precision) {
  switch (precision) {
    case sk::Precision::Default:
    case sk::Precision::Single: return sk::Storage::Default;
    case sk::Precision::Half: return sk::Storage::Half;
    case sk::Precision::Extended: return sk::Storage::Extended;
    case sk::Precision::Double: return sk::Storage::Double;
  }
  return sk::Storage::Default;
}

lattice::Sides sidesOf(const Boundary& boundary) {
  const auto code = [](Edge edge) { return static_cast<unsigned>(edge); };
  const auto& [edges, t, closedZ] = boundary;
  return {.left = code(edges[0]),
          .right = code(edges[1]),
          .bottom = code(edges[2]),
          .top = code(edges[3]),
          .closedZ = closedZ,
          .walls = sk::float4{static_cast<float>(t[0]), static_cast<float>(t[1]), static_cast<float>(t[2]),
                              static_cast<float>(t[3])}};
}

/// Floats and halves are summed exactly, wider numbers in their own precision.
sk::CallOptions sumsIn(sk::Precision precision) {
  sk::CallOptions options;
  if (precision == sk::Precision::Extended || precision == sk::Precision::Double) {
    options.precision = precision;
  } else {
    options.accumulate = sk::Accumulate::Exact;
  }
  return options;
}

}  // namespace

sk::Shape shapeOf(const Grid& grid) {
  if (grid.isSpace()) return {grid.depth, grid.height, grid.width};
  return {grid.height, grid.width};
}

Lattice::Lattice(const Space& space, const Model& model)
    : space_(space),
      model_(model),
      c_(coefficientsOf(model)),
      options_{.precision = model.precision},
      sums_(sumsIn(model.precision)) {
  allocate(now_);
  if (model.latentHeat) warmed_.emplace(makeStream("warmed"));
}

Lattice::Lattice(sk::Device& device, const Model& model)
    : Lattice(Space(device, shapeOf(model.grid)), model) {}

GridStream<float> Lattice::makeStream(std::string_view name) {
  GridStream<float> stream =
      namedStream<float>(space_, storageFor(model_.precision), fmt::format("lattice::{}", name));
  stream.fill(0.0f);
  return stream;
}

void Lattice::allocate(Fields& fields) {
  for (const Field field : fieldsOf(model_)) {
    auto& place = fields[placeOf(field)];
    if (!place) place.emplace(makeStream(nameOf(field)));
  }
}

GridStream<float>& Lattice::stream(Field field) {
  auto& place = now_[placeOf(field)];
  if (!place) throw std::logic_error(fmt::format("the scene has no field '{}'", nameOf(field)));
  return *place;
}

void Lattice::write(Field field, std::span<const double> values) { stream(field).writeReals(values); }
std::vector<double> Lattice::read(Field field) { return stream(field).readReals(); }

void Lattice::advance(std::int64_t steps) {
  for (std::int64_t i = 0; i < steps; ++i) step(now_, now_);
}

double Lattice::advanceAndMeasure() {
  allocate(next_);
  step(now_, next_);
  double most = 0.0;
  for (const Field field : fieldsOf(model_)) {
    if (field == Field::Pressure) continue;
    most = std::max<double>(most, lattice::change.with(options_)(in(now_, field), in(next_, field)));
  }
  std::swap(now_, next_);
  return most;
}

void Lattice::step(Fields& from, Fields& to) {
  if (model_.flow) stepFlow(from, to);
  if (model_.hasTemperature()) stepTemperature(from, to);
  if (model_.reaction) stepReaction(from, to);
}

void Lattice::stepFlow(Fields& from, Fields& to) {
  const Boundary& b = model_.boundary;
  const lattice::Fluid fluid{c_.carry, c_.viscosity, c_.damping, c_.lift, c_.rest, c_.slope};
  lattice::push.with(options_)(b.closedX(), b.closedY(), model_.flow->slip, fluid, in(from, Field::VelocityX),
                               in(from, Field::VelocityY), in(from, Field::Pressure),
                               in(from, Field::Temperature), in(to, Field::VelocityX),
                               in(to, Field::VelocityY));
}

void Lattice::stepTemperature(Fields& from, Fields& to) {
  GridStream<float>& before = in(from, Field::Temperature);
  GridStream<float>& after = in(to, Field::Temperature);
  GridStream<float>& warmed = warmed_ ? *warmed_ : after;
  GridStream<float>* current = &before;
  if (model_.flow) {
    lattice::convect.with(options_)(sidesOf(model_.boundary),
                                    {.spread = c_.spread,
                                     .carry = c_.carry,
                                     .stiffness = c_.stiffness,
                                     .t = before,
                                     .vx = in(to, Field::VelocityX),
                                     .vy = in(to, Field::VelocityY)},
                                    in(from, Field::Pressure), warmed, in(to, Field::Pressure));
    current = &warmed;
  } else if (model_.diffusion) {
    lattice::diffuse.with(options_)(sidesOf(model_.boundary), c_.spread, before, warmed);
    current = &warmed;
  }
  if (model_.buoyancy) {
    rise(*current, warmed);
    current = &warmed;
  }
  if (model_.latentHeat) exchange(before, *current, after);
}

void Lattice::rise(GridStream<float>& from, GridStream<float>& to) {
  const bool closed = model_.boundary.closedY();
  const auto density = static_cast<unsigned>(model_.buoyancy->density);
  const lattice::Boiling b{c_.point, c_.alpha, c_.sigma, c_.latent};
  lattice::rise.with(options_)(closed, density, b, from, to);
}

void Lattice::exchange(GridStream<float>& before, GridStream<float>& after, GridStream<float>& to) {
  const Boundary& b = model_.boundary;
  const lattice::Boiling boiling{c_.point, c_.alpha, c_.sigma, c_.latent};
  lattice::exchange.with(options_)({.x = b.closedX(), .y = b.closedY(), .z = b.closedZ}, boiling, before,
                                   after, to);
}

void Lattice::stepReaction(Fields& from, Fields& to) {
  const Boundary& b = model_.boundary;
  const lattice::Medium medium{c_.feed, c_.kill, c_.spreadU, c_.spreadV, c_.reactionStep};
  if (model_.flow) {
    lattice::reactStirred.with(options_)(b.closedX(), b.closedY(), medium, c_.stirring, in(from, Field::U),
                                         in(from, Field::V), in(to, Field::VelocityX),
                                         in(to, Field::VelocityY), in(to, Field::U), in(to, Field::V));
  } else {
    lattice::react.with(options_)(b.closedX(), b.closedY(), medium, in(from, Field::U), in(from, Field::V),
                                  in(to, Field::U), in(to, Field::V));
  }
}

Observation Lattice::observe(Field field) {
  const auto [least, most, total, broken] = lattice::observe.with(sums_)(stream(field));
  return {least, most, total / static_cast<double>(model_.grid.cells()), broken};
}

std::int64_t Lattice::firstBroken(Field field) {
  const std::vector<double> values = read(field);
  const auto found = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  return found == values.end() ? -1 : found - values.begin();
}

double Lattice::nusselt() {
  const auto& [edges, temperatures, closedZ] = model_.boundary;
  const Grid& g = model_.grid;
  GridStream<float>& t = stream(Field::Temperature);
  const auto isWall = [&](Boundary::Side side) { return edges[side] == Edge::Wall; };
  const bool upright = isWall(Boundary::Bottom) && isWall(Boundary::Top);
  const Boundary::Side first = upright ? Boundary::Bottom : Boundary::Left;
  const Boundary::Side second = upright ? Boundary::Top : Boundary::Right;
  if (!isWall(first) || !isWall(second)) return 0.0;
  const bool isFirst = temperatures[first] >= temperatures[second];
  const std::int64_t cells = upright ? g.height : g.width, along = upright ? g.width : g.height;
  const std::int64_t place = isFirst ? 0 : cells - 1;
  const sk::Box row =
      upright ? sk::Box{{place, 0}, {place + 1, along}} : sk::Box{{0, place}, {along, place + 1}};
  const double beside = lattice::sum.with(sums_).with({.box = row})(t) / static_cast<double>(along);
  const double wall = temperatures[isFirst ? first : second];
  const double other = temperatures[isFirst ? second : first];
  return 2.0 * static_cast<double>(cells) * (wall - beside) / (wall - other);
}

double Lattice::kineticEnergy() {
  const double total = lattice::energy.with(sums_)(stream(Field::VelocityX), stream(Field::VelocityY));
  return 0.5 * total / static_cast<double>(model_.grid.cells());
}

double Lattice::vapour() {
  const int count = lattice::above.with(options_)(c_.point, stream(Field::Temperature));
  return count / static_cast<double>(model_.grid.cells());
}

int Lattice::streams() const {
  const auto count = [](const Fields& fields) {
    return std::count_if(fields.begin(), fields.end(), [](const auto& field) { return field.has_value(); });
  };
  return static_cast<int>(count(now_) + count(next_)) + static_cast<int>(warmed_.has_value());
}

int Lattice::streamsOf(const Model& model) {
  return static_cast<int>(fieldsOf(model).size()) + (model.latentHeat ? 1 : 0);
}

double Lattice::bytesOf(sk::Precision precision) {
  return precision == sk::Precision::Half                                             ? 2.0
         : precision == sk::Precision::Extended || precision == sk::Precision::Double ? 8.0
                                                                                      : 4.0;
}

double fastestOf(Lattice& lattice) {
  const Observation x = lattice.observe(Field::VelocityX), y = lattice.observe(Field::VelocityY);
  return std::max({-x.least, x.most, -y.least, y.most});
}

std::vector<sk::TableReport> tablesOf(const Model& model, const sk::Device& device) {
  if (!model.buoyancy || model.buoyancy->density == Density::Computed) return {};
  std::vector<sk::TableReport> tables = device.tables();
  const bool isLinear = model.buoyancy->density == Density::Linear;
  const std::string_view name = isLinear ? "lattice::linearTanh" : "lattice::cubicTanh";
  std::erase_if(tables, [&](const sk::TableReport& table) { return table.function != name; });
  return tables;
}

}  // namespace examples
