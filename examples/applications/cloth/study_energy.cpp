// SPDX-License-Identifier: MIT
//
// Energy over many steps: of one spring, whose modified energy Verlet conserves to the last bit but for rounding, and of a cloth of
// springs, whose energy swings with dt^2 and must not drift.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "study.hpp"

namespace examples {
namespace {

constexpr int steps = 100'000;
constexpr int between = 50;  // steps from one look to the next

/// One point on a spring without length at rest: x'' = -omega^2 x, dt omega = 0.01.
Scene oscillator(Verlet verlet) {
  Scene s;
  s.cloth.columns = 2;
  s.cloth.rows = 1;
  s.cloth.mass = 2;  // 1 kg each
  s.cloth.rest = 0;
  s.links.springs = true;
  s.links.structural = 100.0;
  s.pins.push_back({{0}, {}, 0, 0});
  s.run.dt = 0.001;
  s.run.verlet = verlet;
  return s;
}

/// 9 x 9 points, held at two corners, falling from the horizontal.
Scene springCloth(Verlet verlet) {
  Scene s;
  s.cloth.columns = s.cloth.rows = 9;
  s.cloth.mass = 0.81;
  s.cloth.shake = 0.001;
  s.links.springs = true;
  s.links.structural = 100.0;
  s.links.shear = 50.0;
  s.gravity = {0, -9.81, 0};
  s.pins.push_back({{0}, {}, 0, 0});
  s.pins.push_back({{8}, {}, 0, 0});
  s.run.dt = 0.001;
  s.run.verlet = verlet;
  return s;
}

/// Positions before and after the last step.
struct Pair {
  std::vector<double> now, before;
};
Pair pairOf(const Simulation& simulation, const Scene& scene) {
  const State state = simulation.state();
  Pair pair;
  for (std::size_t i = 0; i < state.displacements.size(); ++i) {
    const double x = state.positions[i / 3 * 4 + i % 3];
    const double kept = state.displacements[i];
    pair.now.push_back(x);
    pair.before.push_back(scene.run.verlet == Verlet::Displacements ? x - kept : kept);
  }
  return pair;
}

/// (v^2 + omega^2 x(n) x(n-1)) / 2 with v = (x(n) - x(n-1)) / dt.
double modifiedEnergy(const Scene& scene, const Constants& constants, const Pair& p) {
  const double v = (p.now[3] - p.before[3]) / scene.run.dt;
  const double squared = constants.springs.structural / (scene.run.dt * scene.run.dt);
  return 0.5 * (v * v + squared * p.now[3] * p.before[3]);
}

double potential(const Scene& scene, const Constants& constants, const std::vector<double>& x) {
  const int columns = scene.cloth.columns, rows = scene.cloth.rows;
  const LinkConstants& k = constants.springs;
  const auto at = [&](int c, int r) {
    const auto i = 3 * static_cast<std::size_t>(r * columns + c);
    return Vector{x[i], x[i + 1], x[i + 2]};
  };
  double sum = 0;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      if (r > 0 || (c != 0 && c != columns - 1)) sum -= constants.pointMass * dot(scene.gravity, at(c, r));
      for (const int link : {0, 2, 4, 6}) {
        const int nc = c + linkDirections[link].x, nr = r + linkDirections[link].y;
        if (nc < 0 || nc >= columns || nr >= rows) continue;
        const double over = length(at(nc, nr) - at(c, r)) - (link == 0   ? k.right
                                                             : link == 2 ? k.down
                                                                         : k.diagonal);
        sum += 0.5 * (link < 4 ? *scene.links.structural : *scene.links.shear) * over * over;
      }
    }
  }
  return sum;
}

double kinetic(const Scene& scene, const Constants& constants, const Pair& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.now.size(); ++i) {
    const double v = (p.now[i] - p.before[i]) / scene.run.dt;
    sum += 0.5 * constants.pointMass * v * v;
  }
  return sum;
}

struct Energies {
  std::vector<double> totals;
  double scale;  ///< what they are set against
};

Energies measure(sk::Device& device, const Scene& scene, sk::Precision precision, bool one) {
  Simulation simulation = simulate(device, scene, precision);
  const Constants constants = constantsOf(scene);
  Energies e{{}, 0};
  for (int step = 0; step < steps; step += between) {
    simulation.advance(between);
    const Pair p = pairOf(simulation, scene);
    if (one) {
      e.totals.push_back(modifiedEnergy(scene, constants, p));
      e.scale = std::abs(e.totals.front());
    } else {
      const double motion = kinetic(scene, constants, p);
      e.totals.push_back(motion +
                         0.5 * (potential(scene, constants, p.now) + potential(scene, constants, p.before)));
      e.scale = std::max(e.scale, motion);
    }
  }
  return e;
}

std::vector<std::string> rowOf(const char* system, const char* trial, const Energies& e) {
  const auto tenth = static_cast<std::ptrdiff_t>(e.totals.size() / 10);
  const auto mean = [&](auto begin) {
    return std::accumulate(begin, begin + tenth, 0.0) / static_cast<double>(tenth);
  };
  const auto [least, most] = std::minmax_element(e.totals.begin(), e.totals.end());
  const double drift = mean(e.totals.end() - tenth) - mean(e.totals.begin());
  return {system, trial, fmt::format("{:.1e}", (*most - *least) / e.scale),
          fmt::format("{:+.1e}", drift / e.scale)};
}

}  // namespace

Findings studyEnergy(sk::Device& device, bool) {
  Table table({"system", "Verlet with", "largest minus least", "last tenth minus first, means"});
  for (const Trial& t : trials) {
    table.add(rowOf("one spring", t.name, measure(device, oscillator(t.verlet), t.precision, true)));
  }
  for (const Trial& t : trials) {
    table.add(rowOf("9 x 9 points", t.name, measure(device, springCloth(t.verlet), t.precision, false)));
  }
  return {table.markdown(Align::Right)};
}

}  // namespace examples
