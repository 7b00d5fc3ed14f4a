// SPDX-License-Identifier: MIT
//
// A cloth that crumples: where two precisions part, and the statistics on which they agree nevertheless.
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "study.hpp"

namespace examples {
namespace {

Scene crumpling(std::uint32_t seed) {
  Scene s;
  s.cloth.columns = s.cloth.rows = 41;
  s.cloth.origin = {-0.5, 0.8, -0.5};
  s.cloth.shake = 0.001;
  s.cloth.seed = seed;
  s.links.structural = 1.0;
  s.links.shear = 0.5;
  s.links.bend = 0.1;
  s.links.iterations = 2;
  s.gravity = {0, -9.81, 0};
  s.damping = 0.3;
  Body ball;
  ball.at = {0.06, 0.4, 0.03};
  ball.size = {0.22, 0, 0};
  Body floor;
  floor.kind = Kind::Plane;
  floor.along = {0, 1, 0};
  s.bodies = {ball, floor};
  s.thickness = 0.01;
  s.run.dt = 0.0005;
  return s;
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size() / 4));
}

struct Heights {
  double mean = 0, deviation = 0;
};
Heights heightsOf(const std::vector<double>& positions) {
  const auto count = static_cast<double>(positions.size() / 4);
  Heights h;
  for (std::size_t i = 1; i < positions.size(); i += 4) h.mean += positions[i] / count;
  for (std::size_t i = 1; i < positions.size(); i += 4)
    h.deviation += (positions[i] - h.mean) * (positions[i] - h.mean) / count;
  h.deviation = std::sqrt(h.deviation);
  return h;
}

std::string three(double a, double b, double c) {
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", 100 * a, 100 * b, 100 * c);
}

}  // namespace

Findings studyChaos(sk::Device& device, bool) {
  const Scene scene = crumpling(1), other = crumpling(2);
  Simulation single = simulate(device, scene), exact = simulate(device, scene, sk::Precision::Double),
             shaken = simulate(device, other, sk::Precision::Double);
  Table table({"time", "single from double", "another shake from double", "mean strain, %", "mean height, cm",
               "its deviation, cm", "energy, mJ"});
  for (const double time : {0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.2, 2.0, 3.0}) {
    for (Simulation* s : {&single, &exact, &shaken})
      s->advance(std::llround(time / scene.run.dt) - s->step());
    const std::vector<double> p = single.positions(), q = exact.positions(), r = shaken.positions();
    const Heights a = heightsOf(p), b = heightsOf(q), c = heightsOf(r);
    const Observation x = single.observe(), y = exact.observe(), z = shaken.observe();
    table.add({fmt::format("{:.1f} s", time), fmt::format("{:.1e} m", apart(p, q)),
               fmt::format("{:.1e} m", apart(r, q)), three(x.strain, y.strain, z.strain),
               three(a.mean, b.mean, c.mean), three(a.deviation, b.deviation, c.deviation),
               fmt::format("{:.0f}, {:.0f}, {:.0f}", 1e3 * x.energy(), 1e3 * y.energy(), 1e3 * z.energy())});
  }
  return {table.markdown(Align::Right)};
}

}  // namespace examples
