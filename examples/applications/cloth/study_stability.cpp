// SPDX-License-Identifier: MIT
//
// Limits of stability, found by bisection on the device, beside those that the largest eigenvalue of the cloth at rest predicts.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <fmt/format.h>

#include "study.hpp"

namespace examples {
namespace {

/// A flat sheet without forces, its points off by a 100,000th of their distances at random.
Scene sheet(int columns, int rows) {
  Scene s;
  s.cloth.columns = columns;
  s.cloth.rows = rows;
  s.cloth.width = 0.1 * (columns - 1);
  s.cloth.height = 0.1 * std::max(1, rows - 1);
  s.cloth.mass = 0.01 * columns * rows;
  s.cloth.shake = 1e-6;
  s.run.dt = 0.01;
  return s;
}

/// The largest eigenvalue of the links' linearised operator, u_i -> sum over links of k * share * n (n . (u_i - u_j)), by
/// the power method.
double largestEigenvalue(const Scene& scene, double share) {
  const int columns = scene.cloth.columns, rows = scene.cloth.rows;
  const double stiffness[3] = {scene.links.structural.value_or(0), scene.links.shear.value_or(0),
                               scene.links.bend.value_or(0)};
  const auto count = static_cast<std::size_t>(scene.points());
  std::vector<Vector> u(count), next(count);
  std::mt19937 random(1);
  for (Vector& v : u) v = {random() / 4294967296.0 - 0.5, 0, random() / 4294967296.0 - 0.5};
  double value = 0;
  for (int round = 0; round < 4000; ++round) {
    double size = 0;
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const auto i = static_cast<std::size_t>(y * columns + x);
        next[i] = {};
        for (int link = 0; link < 12; ++link) {
          const int nx = x + linkDirections[link].x, ny = y + linkDirections[link].y;
          if (stiffness[link / 4] == 0 || nx < 0 || nx >= columns || ny < 0 || ny >= rows) continue;
          const Vector n =
              normalized(Vector{double(linkDirections[link].x), 0, double(linkDirections[link].y)});
          const Vector d = u[i] - u[static_cast<std::size_t>(ny * columns + nx)];
          next[i] += (share * stiffness[link / 4] * dot(n, d)) * n;
        }
        size += dot(next[i], next[i]);
      }
    }
    value = std::sqrt(size);
    for (std::size_t i = 0; i < count; ++i) u[i] = (1 / value) * next[i];
  }
  return value;
}

/// Whether what was off at first has grown a thousandfold.
bool explodes(sk::Device& device, const Scene& scene) {
  Simulation simulation = simulate(device, scene);
  for (int look = 0; look < 10; ++look) {
    simulation.advance(200);
    const Census census = simulation.census();
    if (census.broken > 0 || census.fastest * scene.run.dt > 1e3 * scene.cloth.shake) return true;
  }
  return false;
}

/// Between a stable and an unstable value.
double boundary(double stable, double unstable, const std::function<bool(double)>& isUnstable) {
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (stable + unstable);
    (isUnstable(middle) ? unstable : stable) = middle;
  }
  return 0.5 * (stable + unstable);
}

std::vector<std::string> springRow(sk::Device& device, const char* name, Scene scene) {
  scene.links.springs = true;
  const double mass = scene.cloth.mass / static_cast<double>(scene.points());
  const double predicted = 2 / std::sqrt(largestEigenvalue(scene, 1.0) / mass);
  const double found = boundary(0.5 * predicted, 1.5 * predicted, [&](double dt) {
    scene.run.dt = dt;
    return explodes(device, scene);
  });
  return {name, "dt", fmt::format("{:.5f} s", predicted), fmt::format("{:.5f} s", found),
          fmt::format("{:.4f}", found / predicted)};
}

std::vector<std::string> relaxRow(sk::Device& device, const char* name, Scene scene, int rounds) {
  scene.links.iterations = rounds;
  // A step multiplies by l = (1 - f a)^rounds before it adds the displacement: x(n+1) = l (2 x(n) - x(n-1)) is bounded for
  // -1/3 <= l <= 1.
  const double reach = 1 + (rounds % 2 == 0 ? 1.0 : std::pow(1.0 / 3.0, 1.0 / rounds));
  const double predicted = reach * stiffnessAround(scene) / largestEigenvalue(scene, 0.5);
  const double found = boundary(0.5 * predicted, 1.5 * predicted, [&](double relaxation) {
    scene.links.relaxation = relaxation;
    return explodes(device, scene);
  });
  return {fmt::format("{}, {} round{}", name, rounds, rounds == 1 ? "" : "s"), "relaxation",
          fmt::format("{:.4f}", predicted), fmt::format("{:.4f}", found),
          fmt::format("{:.4f}", found / predicted)};
}

}  // namespace

Findings studyStability(sk::Device& device, bool) {
  Scene pair = sheet(2, 1), chain = sheet(33, 1), woven = sheet(17, 17), whole = sheet(17, 17);
  for (Scene* s : {&pair, &chain, &woven, &whole}) s->links.structural = 1.0;
  woven.links.shear = whole.links.shear = 0.5;
  whole.links.bend = 0.25;
  Table table({"links", "limit of", "predicted", "found", "ratio"});
  table.add(springRow(device, "springs, 2 points", pair));
  table.add(springRow(device, "springs, 33 points in a row", chain));
  table.add(springRow(device, "springs, 17 x 17, structural and shear", woven));
  table.add(springRow(device, "springs, 17 x 17, all", whole));
  for (const int rounds : {1, 2, 3})
    table.add(relaxRow(device, "constraints, 33 points in a row", chain, rounds));
  for (const int rounds : {1, 2})
    table.add(relaxRow(device, "constraints, 17 x 17, structural and shear", woven, rounds));
  table.add(relaxRow(device, "constraints, 17 x 17, all", whole, 1));
  return {table.markdown(Align::Right)};
}

}  // namespace examples
