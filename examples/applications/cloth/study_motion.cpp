// SPDX-License-Identifier: MIT
//
// What has a closed form: a fall, a pendulum, a hanging chain.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "study.hpp"

namespace examples {
namespace {

constexpr double g = 9.81;

Scene fallingPoint(double dt, Verlet verlet) {
  Scene s;
  s.cloth.columns = s.cloth.rows = 1;
  s.cloth.origin = {0, 100, 0};
  s.gravity = {0, -g, 0};
  s.run.dt = dt;
  s.run.verlet = verlet;
  return s;
}

/// A point at 1 m from a pin, let go at an angle from straight down, on a constraint or on a spring that 1 kg makes 10 um longer.
Scene pendulum(double dt, double angle, bool spring) {
  Scene s;
  s.cloth.columns = 2;
  s.cloth.rows = 1;
  s.cloth.mass = 2;
  s.cloth.right = {std::sin(angle), -std::cos(angle), 0};
  s.links.springs = spring;
  s.links.structural = spring ? 1e6 : 1.0;
  s.gravity = {0, -g, 0};
  s.pins.push_back({{0}, {}, 0, 0});
  s.run.dt = dt;
  return s;
}

/// By the arithmetic-geometric mean (C. F. Gauss): 2 pi sqrt(l / g) / agm(1, cos(angle / 2)).
double periodOf(double angle) {
  double a = 1.0, b = std::cos(angle / 2);
  while (a - b > 1e-15) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * std::numbers::pi / std::sqrt(g) / a;
}

/// The first whole period, from where x goes through 0 upwards to where it does so again, interpolated between steps.
double measuredPeriod(sk::Device& device, const Scene& scene) {
  Simulation simulation = simulate(device, scene, sk::Precision::Double);
  double last = simulation.positions()[4], first = -1;
  while (true) {
    simulation.advance(1);
    const double x = simulation.positions()[4];
    if (last < 0 && x >= 0) {
      const double at = (static_cast<double>(simulation.step()) - x / (x - last)) * scene.run.dt;
      if (first >= 0) return at - first;
      first = at;
    }
    last = x;
  }
}

Scene hangingChain(double dt) {
  Scene s;
  s.cloth.columns = 41;
  s.cloth.rows = 1;
  s.cloth.width = 2.0;
  s.cloth.origin = {-1, 0, 0};
  s.links.structural = 1.0;
  s.links.iterations = 4;
  s.links.relaxation = 1.5;
  s.gravity = {0, -g, 0};
  s.damping = 2.0;
  s.pins.push_back({{0}, {0.25, 0, 0}, 0, 0.5});
  s.pins.push_back({{40}, {-0.25, 0, 0}, 0, 0.5});
  s.run.dt = dt;
  return s;
}

/// The catenary y = c (cosh(x / c) - cosh(span / 2c)) of this length, by Newton's method for a = span / 2c: sinh(a) / a = length / span.
double catenaryScale(double span, double length) {
  double a = std::sqrt(6 * (length / span - 1));
  for (int i = 0; i < 50; ++i) {
    const double value = std::sinh(a) - a * length / span, slope = std::cosh(a) - length / span;
    a -= value / slope;
  }
  return span / (2 * a);
}

}  // namespace

Findings studyFall(sk::Device& device, bool) {
  constexpr double expected = 100 - g / 2;
  Table table({"dt", "positions, single", "displacements, single", "displacements, double"});
  for (const double dt : {1e-2, 1e-3, 5e-4, 1e-4, 1e-5}) {
    std::vector<std::string> cells{fmt::format("{:g} s", dt)};
    for (const Trial& t : trials) {
      if (t.precision == sk::Precision::Extended) continue;
      Simulation simulation = simulate(device, fallingPoint(dt, t.verlet), t.precision);
      simulation.advance(std::llround(1.0 / dt));
      cells.push_back(fmt::format("{:+.1e} m", simulation.positions()[1] - expected));
    }
    table.add(cells);
  }
  return {table.markdown(Align::Right)};
}

Findings studyPendulum(sk::Device& device, bool) {
  Table table({"let go at", "closed form", "spring, dt = 1 ms", "0.5 ms", "constraint, dt = 1 ms", "0.5 ms"});
  for (const double degrees : {10.0, 45.0, 90.0, 150.0}) {
    const double angle = degrees * std::numbers::pi / 180, expected = periodOf(angle);
    std::vector<std::string> cells{fmt::format("{:g} degrees", degrees), fmt::format("{:.6f} s", expected)};
    for (const bool spring : {true, false}) {
      for (const double dt : {0.001, 0.0005}) {
        cells.push_back(
            fmt::format("{:+.1e}", measuredPeriod(device, pendulum(dt, angle, spring)) / expected - 1));
      }
    }
    table.add(cells);
  }
  return {table.markdown(Align::Right)};
}

Findings studyCatenary(sk::Device& device, bool) {
  Table table({"dt", "longer than at rest", "sag", "the catenary's", "largest distance from it"});
  for (const double dt : {2e-3, 1e-3, 5e-4, 2.5e-4}) {
    const Scene scene = hangingChain(dt);
    Simulation simulation = simulate(device, scene);
    simulation.advance(std::llround(12.0 / dt));
    const std::vector<double> p = simulation.positions();
    double length = 0, lowest = 0;
    for (std::size_t i = 0; i + 1 < p.size() / 4; ++i) {
      length += std::hypot(p[4 * i + 4] - p[4 * i], p[4 * i + 5] - p[4 * i + 1]);
      lowest = std::min(lowest, p[4 * i + 1]);
    }
    const double span = p[p.size() - 4] - p[0];
    const double c = catenaryScale(span, length);
    const auto height = [&](double x) { return c * (std::cosh(x / c) - std::cosh(span / (2 * c))); };
    double off = 0;
    for (std::size_t i = 0; i < p.size() / 4; ++i)
      off = std::max(off, std::abs(p[4 * i + 1] - height(p[4 * i])));
    table.add({fmt::format("{:g} s", dt), fmt::format("{:.2g} %", 100 * (length / scene.cloth.width - 1)),
               fmt::format("{:.4f} m", -lowest), fmt::format("{:.4f} m", -height(0)),
               fmt::format("{:.1e} m", off)});
  }
  return {table.markdown(Align::Right)};
}

}  // namespace examples
