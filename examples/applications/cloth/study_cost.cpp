// SPDX-License-Identifier: MIT
//
// What each part of the model costs: scenes that have one part more each, beside the whole model, in which what the scene has not
// does nothing.
#include <fmt/format.h>

#include "cost.hpp"
#include "study.hpp"

namespace examples {
namespace {

struct Case {
  std::string name;
  Scene scene;
};

Scene inertia() {
  Scene s;
  s.cloth.columns = s.cloth.rows = 256;
  s.cloth.shake = 1e-4;
  s.cloth.origin = {-0.5, 0.3, -0.5};
  s.gravity = {0, -9.81, 0};
  s.run.dt = 0.0005;
  return s;
}

/// Each has what the one before has, but for the laws and rounds that are named.
std::vector<Case> cases() {
  std::vector<Case> all = {{"inertia and gravity", inertia()}};
  const auto add = [&](const char* name, const auto& change) {
    Scene s = all.back().scene;
    change(s);
    all.push_back({name, s});
  };
  add("with structural constraints", [](Scene& s) { s.links.structural = 1.0; });
  add("without square roots", [](Scene& s) { s.links.law = Law::Jakobsen; });
  add("with 4 rounds", [](Scene& s) {
    s.links.law = Law::Exact;
    s.links.iterations = 4;
  });
  add("1 round, and shear", [](Scene& s) {
    s.links.iterations = 1;
    s.links.shear = 0.5;
  });
  add("and bend", [](Scene& s) { s.links.bend = 0.2; });
  add("and a sphere and the floor", [](Scene& s) {
    Body ball, floor;
    ball.size = {0.25, 0, 0};
    floor.kind = Kind::Plane;
    floor.along = {0, 1, 0};
    s.bodies = {ball, floor};
  });
  add("and wind", [](Scene& s) {
    s.wind = WindSettings{};
    s.wind->velocity = {2, 0, 1};
    s.wind->gust = 0.3;
  });
  add("and tearing", [](Scene& s) { s.tear = 0.5; });
  return all;
}

}  // namespace

Findings studyCost(sk::Device& device, bool) {
  Table table({"a scene of 256 x 256 points", "passes", "bytes a point", "ms", "full: passes",
               "bytes a point", "ms", "ratio", "difference"});
  for (const Case& c : cases()) {
    Simulation simulation = simulate(device, c.scene);
    simulation.advance(4);
    const Comparison r = compareWithFull(device, c.scene, sk::Precision::Single, simulation.state());
    const auto points = static_cast<double>(c.scene.points());
    table.add({c.name, fmt::format("{:.4g}", r.required.passes),
               fmt::format("{:.0f}", r.required.bytes / points),
               fmt::format("{:.3g}", r.required.milliseconds), fmt::format("{:.4g}", r.full.passes),
               fmt::format("{:.0f}", r.full.bytes / points), fmt::format("{:.3g}", r.full.milliseconds),
               fmt::format("{:.2f}", r.full.milliseconds / r.required.milliseconds),
               fmt::format("{:.1g} m", r.deviation)});
  }
  return {table.markdown(Align::Right)};
}

}  // namespace examples
