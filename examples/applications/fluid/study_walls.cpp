// SPDX-License-Identifier: MIT
//
// Flows between walls: a cavity with a moving lid, and a channel.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "flow.hpp"
#include "study.hpp"
#include "support/table.hpp"

namespace fluid {

namespace {

// U. Ghia, K. Ghia and C. Shin, "High-Re solutions for incompressible flow using the Navier-Stokes equations and a multigrid method" (1982), tables I and II:
// u along the vertical line through the middle, and v along the horizontal one, on their grid of 129 x 129.
struct Published {
  double reynolds;
  std::array<double, 17> u, v;
};
constexpr std::array<double, 17> heights = {1.0,    0.9766, 0.9688, 0.9609, 0.9531, 0.8516,
                                            0.7344, 0.6172, 0.5,    0.4531, 0.2813, 0.1719,
                                            0.1016, 0.0703, 0.0625, 0.0547, 0.0};
constexpr std::array<double, 17> places = {1.0,    0.9688, 0.9609, 0.9531, 0.9453, 0.9063,
                                           0.8594, 0.8047, 0.5,    0.2344, 0.2266, 0.1563,
                                           0.0938, 0.0781, 0.0703, 0.0625, 0.0};
constexpr std::array<Published, 3> ghia = {{
    {100,
     {1.0, 0.84123, 0.78871, 0.73722, 0.68717, 0.23151, 0.00332, -0.13641, -0.20581, -0.21090, -0.15662,
      -0.10150, -0.06434, -0.04775, -0.04192, -0.03717, 0.0},
     {0.0, -0.05906, -0.07391, -0.08864, -0.10313, -0.16914, -0.22445, -0.24533, 0.05454, 0.17527, 0.17507,
      0.16077, 0.12317, 0.10890, 0.10091, 0.09233, 0.0}},
    {400,
     {1.0, 0.75837, 0.68439, 0.61756, 0.55892, 0.29093, 0.16256, 0.02135, -0.11477, -0.17119, -0.32726,
      -0.24299, -0.14612, -0.10338, -0.09266, -0.08186, 0.0},
     {0.0, -0.12146, -0.15663, -0.19254, -0.22847, -0.23827, -0.44993, -0.38598, 0.05186, 0.30174, 0.30203,
      0.28124, 0.22965, 0.20920, 0.19713, 0.18360, 0.0}},
    {1000,
     {1.0, 0.65928, 0.57492, 0.51117, 0.46604, 0.33304, 0.18719, 0.05702, -0.06080, -0.10648, -0.27805,
      -0.38289, -0.29730, -0.22220, -0.20196, -0.18109, 0.0},
     {0.0, -0.21388, -0.27669, -0.33714, -0.39188, -0.51550, -0.42665, -0.31966, 0.02526, 0.32235, 0.33075,
      0.37095, 0.32627, 0.30353, 0.29012, 0.27485, 0.0}},
}};

Model cavity(std::int64_t n, double reynolds) {
  Model m;
  m.cells = {n, n, 1};
  m.spacing = 1.0 / static_cast<double>(n);
  m.scheme = Scheme::Central;
  m.sides = {Side::Wall, Side::Wall, Side::Wall, Side::Wall, Side::Periodic, Side::Periodic};
  m.sideVelocity[3] = {1.0, 0.0, 0.0};
  m.viscosity = Viscosity{1.0 / reynolds};
  m.tolerance = 3e-5;
  m.cfl = 0.8;
  return m;
}

/// Until no velocity changes by more than `settled` in a time of 1. Returns the largest change.
double settle(Flow& flow, double settled, double longest) {
  double change = 1.0;
  std::vector<double> before = flow.velocity(0);
  while (change > settled && flow.time() < longest) {
    const double start = flow.time();
    while (flow.time() < start + 1.0) flow.step();
    std::vector<double> now = flow.velocity(0);
    change = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) change = std::max(change, std::abs(now[i] - before[i]));
    change /= flow.time() - start;
    before = std::move(now);
  }
  return change;
}

/// A velocity along the line through the middle across its axis, where n is even: faces of the middle and its two neighbours along the line, joined by a cubic.
double onLine(const Flow& flow, int axis, const std::vector<double>& values, double place) {
  const Model& m = flow.model();
  const std::int64_t n = m.cells[0];
  const auto at = [&](std::int64_t k) {
    const std::int64_t middle = n / 2 + 1;
    return values[static_cast<std::size_t>(axis == 0 ? m.index({middle, k, 0}) : m.index({k, middle, 0}))];
  };
  const double p =
      place * static_cast<double>(n) + 0.5;  // in cells of the layered grid, whose first centre is at 1
  // Values and their places: those of the walls are known exactly there.
  const double atLow = 0.0, atHigh = axis == 0 ? 1.0 : 0.0;
  const auto position = [&](std::int64_t k) {
    return k == 0 ? 0.5 : k == n + 1 ? static_cast<double>(n) + 0.5 : static_cast<double>(k);
  };
  const auto value = [&](std::int64_t k) { return k == 0 ? atLow : k == n + 1 ? atHigh : at(k); };
  const auto first = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(p)) - 1, 0, n - 2);
  double sum = 0.0;
  for (std::int64_t i = first; i < first + 4; ++i) {
    double weight = 1.0;
    for (std::int64_t j = first; j < first + 4; ++j)
      if (j != i) weight *= (p - position(j)) / (position(i) - position(j));
    sum += weight * value(i);
  }
  return sum;
}

/// The least and the largest of a velocity along its line.
std::pair<double, double> extremesOf(const Flow& flow, int axis, const std::vector<double>& values) {
  double least = 0.0, largest = 0.0;
  for (int i = 1; i < 2000; ++i) {
    const double place = i / 2000.0;
    if (axis == 0 && place > 0.9) break;  // towards the lid, u rises to 1
    const double value = onLine(flow, axis, values, place);
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  return {least, largest};
}

}  // namespace

Findings studyCavity(sk::Device& device, bool small) {
  examples::Table table({"Re", "cells", "steps", "time", "u, largest difference", "v, largest difference",
                         "at x", "v, all others", "least u", "least v", "largest v", "max \\|div u\\| h"});
  std::vector<examples::Verification> verifications;
  struct Run {
    std::size_t published;
    std::int64_t n;
    double bound;
  };
  const std::vector<Run> runs =
      small ? std::vector<Run>{{0, 16, 0.05}}
            : std::vector<Run>{{0, 32, 0.01}, {0, 64, 0.01}, {1, 64, 0.012}, {1, 128, 0.008}, {2, 128, 0.02}};
  for (const Run& run : runs) {
    const Published& published = ghia[run.published];
    Flow flow(device, cavity(run.n, published.reynolds));
    settle(flow, small ? 1e-2 : 2e-4, small ? 10.0 : 60.0);
    const std::vector<double> u = flow.velocity(0), v = flow.velocity(1);
    double ofU = 0.0, ofV = 0.0, ofOthers = 0.0, where = 0.0;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      ofU = std::max(ofU, std::abs(onLine(flow, 0, u, heights[i]) - published.u[i]));
      const double d = std::abs(onLine(flow, 1, v, places[i]) - published.v[i]);
      if (d > ofV) {
        ofOthers = ofV;
        ofV = d;
        where = places[i];
      } else {
        ofOthers = std::max(ofOthers, d);
      }
    }
    const double leastU = extremesOf(flow, 0, u).first;
    const auto [leastV, largestV] = extremesOf(flow, 1, v);
    const double divergence = flow.divergence() * flow.model().spacing;
    table.add({fmt::format("{:g}", published.reynolds), fmt::format("{0} x {0}", run.n),
               fmt::format("{}", flow.steps()), fmt::format("{:.0f}", flow.time()),
               fmt::format("{:.4f}", ofU), fmt::format("{:.4f}", ofV), fmt::format("{:g}", where),
               fmt::format("{:.4f}", ofOthers), fmt::format("{:.4f}", leastU), fmt::format("{:.4f}", leastV),
               fmt::format("{:.4f}", largestV), fmt::format("{:.1e}", divergence)});
    const bool isMisprinted = published.reynolds == 400;
    std::string reason = "second order on this grid";
    if (isMisprinted) reason += "; without v at x = 0.9063, which is no point of a smooth curve";
    if (published.reynolds == 100)
      reason += "; their least v is 0.0085 from that of later, finer computations";
    examples::Verification close(
        fmt::format("cavity, Re {:g}, {} cells a side, against Ghia et al.", published.reynolds, run.n),
        run.bound, reason);
    close.note(0, ofU);
    close.note(1, isMisprinted ? ofOthers : ofV);
    verifications.push_back(close);
    if (published.reynolds != 100) continue;
    // O. Botella and R. Peyret, "Benchmark spectral results on the lid-driven cavity flow" (1998).
    examples::Verification extremes(
        fmt::format("extremes of the cavity, Re 100, {} cells a side, against Botella and Peyret", run.n),
        8.0 / static_cast<double>(run.n * run.n), "second order: 8 h^2");
    extremes.note(0, std::abs(leastU + 0.2140424));
    extremes.note(1, std::abs(leastV + 0.2538030));
    extremes.note(2, std::abs(largestV - 0.1795728));
    verifications.push_back(extremes);
  }
  return {table.markdown(), verifications};
}

Findings studyPoiseuille(sk::Device& device, bool small) {
  examples::Table table({"cells across", "steps", "largest error", "order", "h^2"});
  std::vector<examples::Verification> verifications;
  examples::Verification exact(
      "speed of a channel against the parabola, beside h^2", 2e-4,
      "a wall half a cell from velocities shifts the parabola by h^2; the tolerance of the solvers");
  double before = 0.0;
  for (const std::int64_t n :
       small ? std::vector<std::int64_t>{8, 16} : std::vector<std::int64_t>{8, 16, 32, 64}) {
    Model m;
    m.cells = {4, n, 1};
    m.spacing = 1.0 / static_cast<double>(n);
    m.scheme = Scheme::MacCormack;
    m.sides[2] = m.sides[3] = Side::Wall;
    m.viscosity = Viscosity{0.1, true};
    m.force = {0.8, 0.0, 0.0};  // the largest speed is force / (8 viscosity) = 1
    m.timeStep = 0.5;
    m.tolerance = 1e-6;
    Flow flow(device, m);
    const int steps = 120;
    for (int i = 0; i < steps; ++i) flow.step();
    const std::vector<double> u = flow.velocity(0);
    double error = 0.0;
    for (std::int64_t y = 1; y <= n; ++y) {
      const double height = (static_cast<double>(y) - 0.5) * m.spacing;
      error = std::max(
          error, std::abs(u[static_cast<std::size_t>(m.index({1, y, 0}))] - 4.0 * height * (1.0 - height)));
    }
    const double predicted = m.spacing * m.spacing;
    table.add({fmt::format("{}", n), fmt::format("{}", steps), fmt::format("{:.3e}", error),
               before == 0.0 ? "" : fmt::format("{:.2f}", std::log2(before / error)),
               fmt::format("{:.3e}", predicted)});
    exact.compare(n, error, predicted);
    before = error;
  }
  return {table.markdown(), {exact}};
}

}  // namespace fluid
