// SPDX-License-Identifier: MIT
//
// The limits of limits.hpp, found by trying: the wave that changes its sign from cell to cell is the first to grow.
#include <algorithm>

#include <fmt/format.h>

#include "lattice.hpp"
#include "limits.hpp"
#include "study.hpp"

namespace examples {
namespace {

std::vector<double> chequered(const Grid& g, double mean, double amplitude) {
  std::vector<double> values;
  for (std::int64_t z = 0; z < g.depth; ++z)
    for (std::int64_t y = 0; y < g.height; ++y)
      for (std::int64_t x = 0; x < g.width; ++x)
        values.push_back(mean + ((x % 2 + y % 2 + z % 2) % 2 == 0 ? amplitude : -amplitude));
  return values;
}

/// Whether the wave has grown a hundred times after so many steps: sound, which only swings, also swells a little.
bool grows(sk::Device& device, const Model& model, Field field, double mean, int steps) {
  constexpr double amplitude = 1e-4;
  Lattice lattice(device, model);
  if (model.reaction) lattice.write(Field::U, chequered(model.grid, 1.0, 0.0));
  lattice.write(field, chequered(model.grid, mean, amplitude));
  if (model.flow) lattice.write(Field::VelocityY, chequered(model.grid, mean, amplitude));
  lattice.advance(steps);
  const Observation o = lattice.observe(field);
  return o.broken > 0 || std::max(o.most - mean, mean - o.least) > 100.0 * amplitude;
}

struct Case {
  std::string name;
  Model model;
  Field field;
  double mean;
  double* step(Model& m) const { return m.reaction ? &m.reaction->timeStep : &m.timeStep; }
};

std::vector<Case> cases() {
  std::vector<Case> result;
  const auto diffusion = [&](const char* name, Grid grid) {
    Model m;
    m.grid = grid;
    m.diffusion = Diffusion{0.7};
    result.push_back({name, m, Field::Temperature, 0.0});
  };
  diffusion("diffusion, line", {64, 1, 1, 0.5});
  diffusion("diffusion, plane", {32, 32, 1, 0.5});
  diffusion("diffusion, space", {16, 16, 16, 0.5});
  Model reaction;
  reaction.grid = {32, 32};
  reaction.reaction = Reaction{0.03, 0.06};
  result.push_back({"Gray-Scott about u = 1", reaction, Field::U, 1.0});
  Model flow;
  flow.grid = {32, 32, 1, 1.0 / 32};
  flow.diffusion = Diffusion{0.0};
  flow.flow = Flow{.sound = 3.0};
  result.push_back({"flow without friction", flow, Field::VelocityX, 0.0});
  flow.flow = Flow{.viscosity = 0.02, .sound = 1.0};
  result.push_back({"flow with friction", flow, Field::VelocityX, 0.0});
  flow.flow = Flow{.viscosity = 0.001, .sound = 3.0, .damping = 0.2};
  result.push_back({"flow, its sound damped", flow, Field::VelocityX, 0.0});
  return result;
}

}  // namespace

Findings studyStability(sk::Device& device, bool small) {
  const int steps = small ? 2000 : 8000;
  const int halvings = 16;
  Table table({"operator", "largest dt found", "theory", "formula", "found / theory"});
  Verification verification("largest stable steps against theory, relative", small ? 2e-3 : 5e-4,
                            "a wave must grow a hundred times within the steps that are tried");
  for (Case& c : cases()) {
    const Limit limit = limitsOf(c.model).back();
    double low = 0.5 * limit.largest, high = 1.5 * limit.largest;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (low + high);
      *c.step(c.model) = middle;
      (grows(device, c.model, c.field, c.mean, steps) ? high : low) = middle;
    }
    table.add({c.name, fmt::format("{:.5g}", low), fmt::format("{:.5g}", limit.largest), limit.formula,
               fmt::format("{:.4f}", low / limit.largest)});
    verification.compare(0, low / limit.largest, 1.0);
  }
  return {table.markdown(), {verification}};
}

}  // namespace examples
