// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include <fmt/format.h>

#include "painter.hpp"
#include "support/record.hpp"
#include "support/stopwatch.hpp"

namespace fluid {

namespace {

/// The text below a picture.
std::string captionOf(const Flow& flow) {
  const Model& m = flow.model();
  return fmt::format("{} cells   {}   step {}   time {:.3g}", sizeText(m),
                     schemeNames[static_cast<std::size_t>(m.scheme)], flow.steps(), flow.time());
}

constexpr const char* csvHeads =
    "step,time,time_step,cfl,speed,divergence_before,divergence_after,residual,iterations,energy";

/// All ranks must come here, for the energy.
std::string rowOf(const Step& s, const Flow& flow) {
  const Projection& p = s.projection;
  return fmt::format("{},{:.9g},{:.9g},{:.4g},{:.9g},{:.4g},{:.4g},{:.4g},{},{:.9g}", flow.steps(),
                     flow.time(), s.timeStep, s.cfl, s.speed, p.before, p.after, p.residual, p.iterations,
                     flow.kineticEnergy());
}

/// The fields of a flow, as the device holds them.
struct State {
  std::vector<std::vector<double>> velocity;
  std::vector<double> smoke, heat;
};

State stateOf(Flow& flow) {
  State state;
  for (int axis = 0; axis < flow.model().rank(); ++axis) state.velocity.push_back(flow.velocity(axis));
  if (flow.model().hasSmoke) state.smoke = flow.values(Scalar::Smoke);
  if (flow.model().hasHeat) state.heat = flow.values(Scalar::Heat);
  return state;
}

void write(Flow& flow, const State& state) {
  for (int axis = 0; axis < flow.model().rank(); ++axis)
    flow.writeVelocity(axis, state.velocity[static_cast<std::size_t>(axis)]);
  if (flow.model().hasSmoke) flow.write(Scalar::Smoke, state.smoke);
  if (flow.model().hasHeat) flow.write(Scalar::Heat, state.heat);
}

/// What is in the middle of the cells, without the layer around the grid: velocities as means of two faces. Empty on ranks other than the first.
examples::GridFile gridFileOf(Flow& flow) {
  const Model& m = flow.model();
  const State state = stateOf(flow);
  examples::GridFile file{{m.cells[0], m.cells[1], m.isSpace() ? m.cells[2] : 1}, m.spacing, {}};
  if (state.velocity.front().empty()) return file;
  examples::FileField velocity{"velocity", 3, {}}, smoke{"smoke", 1, {}}, heat{"temperature", 1, {}};
  for (std::int64_t z = 1; z <= file.cells[2]; ++z) {
    for (std::int64_t y = 1; y <= file.cells[1]; ++y) {
      for (std::int64_t x = 1; x <= file.cells[0]; ++x) {
        const std::array<std::int64_t, 3> cell = {x, y, m.isSpace() ? z : 0};
        const auto here = static_cast<std::size_t>(m.index(cell));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (axis >= state.velocity.size()) {
            velocity.values.push_back(0.0);
            continue;
          }
          std::array<std::int64_t, 3> next = cell;
          ++next[axis];
          const std::vector<double>& u = state.velocity[axis];
          velocity.values.push_back(0.5 * (u[here] + u[static_cast<std::size_t>(m.index(next))]));
        }
        if (m.hasSmoke) smoke.values.push_back(state.smoke[here]);
        if (m.hasHeat) heat.values.push_back(state.heat[here]);
      }
    }
  }
  file.fields.push_back(std::move(velocity));
  if (m.hasSmoke) file.fields.push_back(std::move(smoke));
  if (m.hasHeat) file.fields.push_back(std::move(heat));
  return file;
}

/// Numbers for the cells of the grid, and 0 in the layer around it, as streams have them.
std::vector<double> withLayer(const Model& m, const std::vector<double>& inner) {
  std::vector<double> all(static_cast<std::size_t>(m.shape().size()), 0.0);
  std::size_t i = 0;
  for (std::int64_t z = 0; z < (m.isSpace() ? m.cells[2] : 1); ++z)
    for (std::int64_t y = 0; y < m.cells[1]; ++y)
      for (std::int64_t x = 0; x < m.cells[0]; ++x)
        all[static_cast<std::size_t>(m.index({x + 1, y + 1, m.isSpace() ? z + 1 : 0}))] = inner[i++];
  return all;
}

double rootMeanSquare(const std::vector<double>& a, const std::vector<double>& b) {
  return examples::distance(a, b) / std::sqrt(static_cast<double>(a.size()));
}

/// One step of the same model from the same state, on the device and in double precision on the host, both with a small tolerance.
std::vector<examples::Verification> checkStep(sk::Device& device, const Model& scene, const State& state,
                                              double dt) {
  constexpr double tolerance = 4e-6;
  Model model = scene;
  model.timeStep = dt;
  model.tolerance = std::min(tolerance, scene.tolerance);
  Model precise = model;
  precise.precision = sk::Precision::Double;
  precise.tolerance = 0.01 * model.tolerance;
  sk::Device reference = sk::Device::reference();
  Flow here(device, model), there(reference, precise);
  write(here, state);
  write(there, state);
  const Step step = here.step();
  there.step();
  const State a = stateOf(here), b = stateOf(there);

  const double longest = static_cast<double>(*std::ranges::max_element(model.cells));
  const double scale = std::max({step.speed, step.projection.before * model.spacing, 1e-30});
  // ||G A^-1 r||^2 = r . A^-1 r is at most ||r||^2 divided by the least eigenvalue, (pi / n)^2 in a box.
  examples::Verification velocity(
      "a step's velocity against double precision, root mean square",
      model.tolerance * longest / std::numbers::pi + 64.0 * examples::roundoff,
      fmt::format("the tolerance {:.0e} over the least eigenvalue's root, pi / {:.0f}, and 64 roundings",
                  model.tolerance, longest));
  for (std::size_t axis = 0; axis < a.velocity.size(); ++axis)
    velocity.note(static_cast<std::int64_t>(axis),
                  rootMeanSquare(a.velocity[axis], b.velocity[axis]) / scale);
  std::vector<examples::Verification> found{velocity};
  if (!a.smoke.empty() || !a.heat.empty()) {
    examples::Verification scalars(
        "smoke and heat carried, against double precision, root mean square",
        8.0 * longest * examples::roundoff,
        "positions of up to as many cells as the grid is long are rounded, and slopes are at most 1 a cell");
    for (const auto& [x, y] : {std::pair{&a.smoke, &b.smoke}, std::pair{&a.heat, &b.heat}}) {
      double largest = 1e-30;
      for (const double value : *y) largest = std::max(largest, std::abs(value));
      if (!y->empty()) scalars.note(0, rootMeanSquare(*x, *y) / largest);
    }
    found.push_back(scalars);
  }
  return found;
}

}  // namespace

Flow begin(const linear::Space& space, const Scene& scene) {
  Flow flow(space, scene.model, scene.initial.velocity);
  if (scene.initial.noise > 0.0) {
    std::mt19937 random(scene.initial.random);
    const std::vector<std::int8_t> cells = cellsOf(scene.model);
    for (int axis = 0; axis < scene.model.rank(); ++axis) {
      std::vector<double> values = flow.velocity(axis);
      // Inside of fluid; faces of walls are given, and the layer and obstacles are no fluid.
      const std::vector<double> given = givenVelocity(scene.model, axis, {1e30, 1e30, 1e30});
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double part = random() / 2147483648.0 - 1.0;
        if (given[i] == 1e30) values[i] += scene.initial.noise * part;
      }
      flow.writeVelocity(axis, values);
    }
  }
  if (!scene.initial.smoke.empty()) flow.write(Scalar::Smoke, withLayer(scene.model, scene.initial.smoke));
  if (!scene.initial.heat.empty()) flow.write(Scalar::Heat, withLayer(scene.model, scene.initial.heat));
  flow.project();
  return flow;
}

examples::BytesPerCell memoryFor(const Model& m) {
  // Conjugate gradients and their preconditioner, for the pressure and for each component that diffuses.
  const bool isMultigrid = m.projector == Projector::Multigrid,
             diffuses = m.viscosity && m.viscosity->isImplicit;
  const double vectors =
      Flow::streamsOf(m) + 5.0 + (isMultigrid ? 6.0 : 3.0) + (diffuses ? 4.0 * m.rank() : 0.0);
  const double fields = m.rank() + (m.hasSmoke ? 1.0 : 0.0) + (m.hasHeat ? 1.0 : 0.0);
  const double bytes = m.precision == sk::Precision::Double ? 8.0 : 4.0;
  // The check makes another two flows, one of them in doubles on the host, and reads three states.
  return {.device = 2.0 * vectors * bytes, .host = (vectors + 3.0 * fields + 1.0) * 8.0};
}

Outcome run(const linear::Space& space, const Scene& scene) {
  sk::Device& device = space.device();
  const bool isFirst = space.isFirst();
  Outcome outcome;
  Flow flow = begin(space, scene);
  outcome.streams = flow.streams();
  std::optional<Painter> painter;
  if (!scene.record.output.empty()) painter.emplace(device, scene);
  State beforeLast;
  const auto step = [&](std::int64_t i) {
    const bool isLast = i == scene.steps;
    if (isLast) {
      beforeLast = stateOf(flow);
      device.countPasses(true);
    }
    outcome.milliseconds += examples::millisecondsOf(device, [&] {
      outcome.last = flow.step();
      if (isLast) flow.requireFinite();
    });
    if (isLast) {
      const sk::PassCount count = device.passCount();
      device.countPasses(false);
      outcome.passes = static_cast<double>(count.passes);
      outcome.bytes = static_cast<double>(count.bytesRead + count.bytesWritten);
    }
    const Step& s = outcome.last;
    outcome.shortest = std::min(outcome.shortest, s.timeStep);
    outcome.longest = std::max(outcome.longest, s.timeStep);
    outcome.largestCfl = std::max(outcome.largestCfl, s.cfl);
    outcome.iterations += s.projection.iterations;
    outcome.missed += s.projection.reached ? 0 : 1;
  };
  outcome.pictures = examples::runRecorded({scene.name, scene.steps, scene.record, isFirst, csvHeads, step,
                                            [&] { return rowOf(outcome.last, flow); },
                                            [&] { return painter->paint(flow, captionOf(flow)); },
                                            [&] { return gridFileOf(flow); }});
  outcome.steps = flow.steps();
  outcome.time = flow.time();

  examples::Verification divergence("root mean square of div u * h over the speed, in double precision",
                                    scene.model.tolerance + 4.0 * examples::roundoff,
                                    "the tolerance of the projection, and the rounding of velocities");
  const double scale =
      std::max({outcome.last.speed, outcome.last.projection.before * scene.model.spacing, 1e-30});
  const double left = flow.divergenceMean();
  if (!isFirst) return outcome;
  if (outcome.last.projection.reached)
    divergence.note(0, left / scale);
  else
    divergence.note(0, outcome.last.projection.residual);
  outcome.verifications.push_back(divergence);
  for (examples::Verification& v : checkStep(device, scene.model, beforeLast, outcome.last.timeStep))
    outcome.verifications.push_back(std::move(v));
  return outcome;
}

}  // namespace fluid
