// SPDX-License-Identifier: MIT
//
// What each part of a model adds to a step: streams, passes, bytes and time. A projection takes the same number of iterations in all rows.
#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "run.hpp"
#include "study.hpp"
#include "support/stopwatch.hpp"
#include "support/table.hpp"

namespace fluid {

namespace {

struct Row {
  std::string name;
  Model model;
};

std::vector<Row> rows(std::int64_t n) {
  Model m;
  m.cells = {n, n, 1};
  m.spacing = 1.0 / static_cast<double>(n);
  m.scheme = Scheme::SemiLagrangian;
  m.timeStep = 0.5 * m.spacing;
  m.tolerance = 1e-12;  // never reached
  m.mostIterations = 8;
  std::vector<Row> all{{"periodic, semi-Lagrangian", m}};
  for (int side = 0; side < 4; ++side) m.sides[static_cast<std::size_t>(side)] = Side::Wall;
  m.sideVelocity[3] = {1.0, 0.0, 0.0};
  all.push_back({"and walls", m});
  m.obstacles.push_back({Sphere{{0.5, 0.5, 0.0}, 0.1}, {}});
  all.push_back({"and obstacles", m});
  m.viscosity = Viscosity{1e-4};
  all.push_back({"and viscosity", m});
  m.hasSmoke = true;
  m.sources.push_back({Shape{Sphere{{0.5, 0.2, 0.0}, 0.1}, {}}, 1.0, 1.0});
  all.push_back({"and smoke", m});
  m.hasHeat = true;
  m.buoyancy = Buoyancy{1.0, 0.0, 0.1};
  all.push_back({"and heat with buoyancy", m});
  m.scheme = Scheme::MacCormack;
  all.push_back({"and MacCormack: all of it", m});
  return all;
}

}  // namespace

Findings studyCost(sk::Device& device, bool small) {
  const std::int64_t n = small ? 32 : 256;
  examples::Table table({"a scene", "streams", "passes a step", "MB a step", "ms a step", "of all"});
  struct Measured {
    std::string name;
    Flow flow;
    sk::PassCount count;
    double milliseconds;
  };
  std::vector<Measured> measured;
  for (const Row& row : rows(n)) {
    Scene scene;
    scene.model = row.model;
    scene.initial.noise = 1.0;  // so that there is always something to project
    Flow flow = begin(linear::Space(device, scene.model.shape()), scene);
    flow.step();
    const sk::PassCount count = examples::passesOf(device, [&] { flow.step(); });
    measured.push_back({row.name, std::move(flow), count, 1e300});
  }
  // In turns, since a machine is not always equally fast.
  for (int i = 0; i < (small ? 2 : 25); ++i) {
    for (Measured& m : measured) {
      const double milliseconds = examples::millisecondsOf(device, [&] { m.flow.step(); });
      m.milliseconds = std::min(m.milliseconds, milliseconds);
    }
  }
  examples::Verification fewer(
      "passes that a part of a scene does not add", 0.0,
      "every part but walls and obstacles makes at least one pass that is left out without it");
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Measured& m = measured[i];
    table.add({m.name, fmt::format("{}", m.flow.streams()), fmt::format("{}", m.count.passes),
               fmt::format("{:.1f}", static_cast<double>(m.count.bytesRead + m.count.bytesWritten) / 1e6),
               fmt::format("{:.2f}", m.milliseconds),
               fmt::format("{:.0f} %", 100.0 * m.milliseconds / measured.back().milliseconds)});
    if (i > 2)
      fewer.note(static_cast<std::int64_t>(i), m.count.passes > measured[i - 1].count.passes ? 0.0 : 1.0);
  }
  return {table.markdown(), {fewer}};
}

}  // namespace fluid
