// SPDX-License-Identifier: MIT
//
// Heat that neither comes nor goes: how much of the total is lost to rounding, and that what is not finite is found.
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "lattice.hpp"
#include "observe.sk.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "study.hpp"

namespace examples {
namespace {

/// A warm disc on cool ground.
std::vector<double> warmDisc(const Grid& g) {
  std::vector<double> values;
  for (std::int64_t y = 0; y < g.height; ++y) {
    for (std::int64_t x = 0; x < g.width; ++x) {
      const double dx = static_cast<double>(x) / static_cast<double>(g.width) - 0.4;
      const double dy = static_cast<double>(y) / static_cast<double>(g.height) - 0.4;
      values.push_back(dx * dx + dy * dy < 0.04 ? 1.0 : 0.1);
    }
  }
  return values;
}

/// The sum of the values, with rounding errors that are negligible in doubles.
double totalOf(const std::vector<double>& values) {
  return static_cast<double>(std::accumulate(values.begin(), values.end(), 0.0L));
}

double roundoffOf(sk::Precision precision) {
  return precision == sk::Precision::Half ? 0x1p-11 : precision == sk::Precision::Double ? 0x1p-53 : roundoff;
}

struct Drift {
  double relative, bound, random;
  double compensated, tree;  ///< what the device's sums are off by, relative
};

Drift driftOf(sk::Device& device, const Model& model, std::int64_t steps) {
  Lattice lattice(device, model);
  lattice.write(Field::Temperature, warmDisc(model.grid));
  const double before = totalOf(lattice.read(Field::Temperature));
  lattice.advance(steps);
  const double after = totalOf(lattice.read(Field::Temperature));
  // A cell's step has some eight operations, each rounded by u of a number of which 1 is the largest: at worst all to one side.
  const double bound = 8.0 * static_cast<double>(steps) * roundoffOf(model.precision) *
                       static_cast<double>(model.grid.cells()) / before;
  // Roundings that fall to either side evenly are a third of u each, and add up as their square root.
  const double random = roundoffOf(model.precision) / 3.0 *
                        std::sqrt(8.0 * static_cast<double>(steps * model.grid.cells())) / before;
  const auto& field = lattice.stream(Field::Temperature);
  const double compensated = lattice::sum(field);
  const double tree = lattice::sum.with({.accumulate = sk::Accumulate::Tree})(field);
  return {(after - before) / before, bound, random, compensated / after - 1.0, tree / after - 1.0};
}

}  // namespace

Findings studyConservation(sk::Device& device, bool small) {
  const std::int64_t n = small ? 64 : 128, steps = small ? 500 : 5000;
  Table table({"lattice", "precision", "steps", "heat lost or gained", "random roundings", "bound 8 n u",
               "compensated sum off by", "plain sum off by"});
  Verification verification("heat lost or gained, over its bound", 1.0,
                            "every rounding of every step to one side");
  const auto add = [&](const char* name, Model model) {
    for (const sk::Precision precision :
         {sk::Precision::Half, sk::Precision::Single, sk::Precision::Double}) {
      if (precision == sk::Precision::Double && device.profile() == "essl300") continue;
      model.precision = precision;
      const Drift d = driftOf(device, model, steps);
      table.add({name, std::string(nameOf(precision)), fmt::format("{}", steps),
                 fmt::format("{:+.1e}", d.relative), fmt::format("{:.1e}", d.random),
                 fmt::format("{:.1e}", d.bound), fmt::format("{:.1e}", std::abs(d.compensated)),
                 fmt::format("{:.1e}", std::abs(d.tree))});
      verification.note(0, std::abs(d.relative) / d.bound);
    }
  };
  Model m;
  m.grid = {n, n};
  m.diffusion = Diffusion{0.2};
  add("wraps", m);
  m.boundary.edges.fill(Edge::Insulated);
  add("insulated", m);
  Model flow;
  flow.grid = {n, n, 1, 1.0 / static_cast<double>(n)};
  flow.boundary.edges.fill(Edge::Insulated);
  flow.diffusion = Diffusion{1e-3};
  flow.flow = Flow{.viscosity = 1e-3, .lift = 1.0, .sound = 3.0, .damping = 0.2};
  flow.timeStep = 0.15 / static_cast<double>(n);
  add("insulated, the disc rising in a flow", flow);
  return {table.markdown(), {verification}};
}

Findings studyBroken(sk::Device& device, bool small) {
  const std::int64_t n = small ? 32 : 64;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Table table({"operators", "put into the middle cell", "what the run says"});
  Verification verification("broken fields that were told", 0.0,
                            "each must be, at the cell, field and step where it is seen first");
  const auto add = [&](const char* name, const Model& model, Field field, double value, const char* text,
                       std::int64_t steps) {
    Lattice lattice(device, model);
    if (model.reaction)
      lattice.write(Field::U, std::vector<double>(static_cast<std::size_t>(model.grid.cells()), 1.0));
    std::vector<double> values = lattice.read(field);
    values[static_cast<std::size_t>(n / 2 * n + n / 2)] = value;
    lattice.write(field, values);
    std::string said = "nothing";
    try {
      for (std::int64_t step = 0; step <= steps; ++step) {
        if (step > 0) lattice.advance(1);
        requireFinite(lattice, step);
      }
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
    table.add({name, fmt::format("{} = {}", nameOf(field), text), said});
    verification.note(0, said == "nothing" ? 1.0 : 0.0);
  };
  Model heat;
  heat.grid = {n, n};
  heat.diffusion = Diffusion{0.2};
  heat.buoyancy = Buoyancy{0.02, 10.0};
  heat.latentHeat = LatentHeat{0.1};
  add("boiling", heat, Field::Temperature, std::nan(""), "NaN", 1);
  add("boiling", heat, Field::Temperature, -infinity, "-infinity", 1);
  Model reaction;
  reaction.grid = {n, n};
  reaction.reaction = Reaction{0.03, 0.06};
  add("reaction", reaction, Field::V, std::nan(""), "NaN", 1);
  add("reaction", reaction, Field::V, 1e25, "1e25, whose square overflows", 2);
  Model flow;
  flow.grid = {n, n, 1, 1.0 / static_cast<double>(n)};
  flow.timeStep = 1e-3;
  flow.diffusion = Diffusion{1e-3};
  flow.flow = Flow{.viscosity = 1e-3, .lift = 1.0, .sound = 3.0, .damping = 0.2};
  add("convection", flow, Field::Pressure, infinity, "infinity", 1);
  add("convection", flow, Field::VelocityX, 1e25, "1e25, whose square overflows", 2);
  return {table.markdown(), {verification}};
}

}  // namespace examples
