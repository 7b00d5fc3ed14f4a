// SPDX-License-Identifier: MIT
#include "model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace examples {
namespace {

double spacing(double size, int points) { return points > 1 ? size / (points - 1) : 0.0; }

LinkKinds kindsOf(const LinkSettings& l) {
  return {l.structural.has_value(), l.shear.has_value(), l.bend.has_value()};
}

LinkConstants linkConstants(const Scene& scene, double scale) {
  const Cloth& c = scene.cloth;
  const double right = c.rest * spacing(c.width, c.columns);
  const double down = c.rest * spacing(c.height, c.rows);
  const auto factor = [&](const std::optional<double>& stiffness) {
    return static_cast<float>(stiffness.value_or(0.0) * scale);
  };
  return {
      static_cast<float>(right),      static_cast<float>(down),  static_cast<float>(std::hypot(right, down)),
      factor(scene.links.structural), factor(scene.links.shear), factor(scene.links.bend)};
}

WindConstants windConstants(const Scene& scene, double pointMass) {
  WindConstants result;
  if (!scene.wind) return result;
  const WindSettings& w = *scene.wind;
  const Cloth& c = scene.cloth;
  const double area = spacing(c.width, c.columns) * spacing(c.height, c.rows);
  const double force = 0.5 * w.density * area / pointMass;
  result.velocity = toFloat3(scene.run.dt * w.velocity);
  result.across = static_cast<float>(force * w.across);
  result.along = static_cast<float>(force * w.along);
  result.gust = static_cast<float>(w.gust);
  result.swirl = static_cast<float>(w.swirl);
  result.wave = toFloat3(2.0 * std::numbers::pi / w.wavelength * normalized(w.velocity));
  return result;
}

/// From 0 to 1 and smooth at both ends.
double easing(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

std::int32_t linksAt(int x, int y, int columns, int rows) {
  std::int32_t bits = 0;
  for (int k = 0; k < 12; ++k) {
    const int nx = x + linkDirections[k].x, ny = y + linkDirections[k].y;
    if (nx >= 0 && nx < columns && ny >= 0 && ny < rows) bits |= 1 << k;
  }
  return bits;
}

}  // namespace

Features Features::of(const Scene& scene) {
  Features f;
  (scene.links.springs ? f.springs : f.relaxed) = kindsOf(scene.links);
  f.tearing = scene.tear.has_value();
  f.windy = scene.wind.has_value();
  f.carried =
      std::any_of(scene.pins.begin(), scene.pins.end(), [](const Pin& p) { return p.carry != Vector{}; });
  f.spheres = scene.has(Kind::Sphere);
  f.planes = scene.has(Kind::Plane);
  f.capsules = scene.has(Kind::Capsule);
  f.boxes = scene.has(Kind::Box);
  f.law = scene.links.law;
  f.verlet = scene.run.verlet;
  return f;
}

Features Features::full(const Scene& scene) {
  Features f = of(scene);
  f.springs = f.relaxed = {true, true, true};
  f.tearing = f.windy = f.carried = true;
  // Bodies need displacements: the textbook's form has none.
  f.spheres = f.planes = f.capsules = f.boxes = f.verlet == Verlet::Displacements;
  return f;
}

Constants constantsOf(const Scene& scene) {
  const double dt = scene.run.dt;
  Constants c;
  c.pointMass = scene.cloth.mass / static_cast<double>(scene.points());
  c.gravity = toFloat3(dt * dt * scene.gravity);
  c.keep = static_cast<float>(std::max(0.0, 1.0 - scene.damping * dt));
  const bool springs = scene.links.springs;
  c.springs = linkConstants(scene, springs ? dt * dt / c.pointMass : 0.0);
  c.relaxed = linkConstants(scene, springs ? 0.0 : scene.links.relaxation / stiffnessAround(scene));
  c.wind = windConstants(scene, c.pointMass);
  c.thickness = static_cast<float>(scene.thickness);
  if (scene.tear) c.longest = static_cast<float>(1.0 + *scene.tear);
  c.iterations = scene.links.iterations;
  return c;
}

double stiffnessAround(const Scene& scene) {
  const LinkSettings& l = scene.links;
  const double kinds[3] = {l.structural.value_or(0.0), l.shear.value_or(0.0), l.bend.value_or(0.0)};
  const double stiffest = std::max({kinds[0], kinds[1], kinds[2]});
  if (stiffest <= 0.0) return 1.0;
  // The middle of 5 x 5 points has all twelve links.
  const int columns = std::min(scene.cloth.columns, 5), rows = std::min(scene.cloth.rows, 5);
  double largest = 1.0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      double sum = 0.0;
      for (int link = 0; link < 12; ++link) {
        if ((linksAt(x, y, columns, rows) >> link) & 1) sum += kinds[link / 4] / stiffest;
      }
      largest = std::max(largest, sum);
    }
  }
  return largest;
}

Moment momentAt(const Scene& scene, std::int64_t step) {
  const double dt = scene.run.dt;
  const double begin = static_cast<double>(step) * dt, end = static_cast<double>(step + 1) * dt;
  Moment m;
  if (scene.wind) {
    m.windPhase = static_cast<float>(2.0 * std::numbers::pi * std::fmod(begin / scene.wind->period, 10.0));
  }
  for (const Pin& pin : scene.pins) {
    const double span = std::max(pin.end - pin.begin, 1e-300);
    const double way = easing((end - pin.begin) / span) - easing((begin - pin.begin) / span);
    m.carry.push_back(toFloat3(way * pin.carry));
  }
  for (const Body& body : scene.bodies) {
    m.bodies.push_back({toFloat3(body.at + body.shift(end)), toFloat3(body.shift(end) - body.shift(begin))});
  }
  return m;
}

bool bodiesMove(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body& b) { return b.swing != Vector{}; });
}

FirstState firstState(const Scene& scene, const Constants& constants) {
  const Cloth& c = scene.cloth;
  const double right = spacing(c.width, c.columns), down = spacing(c.height, c.rows);
  std::mt19937 random(c.seed);
  const auto shaken = [&] { return c.shake * (2.0 * (random() / 4294967296.0) - 1.0); };
  const Vec<float> start = -0.5f * vecOf<float>(constants.gravity);
  FirstState state;
  state.pin.assign(static_cast<std::size_t>(scene.points()), -1);
  for (std::size_t i = 0; i < scene.pins.size(); ++i) {
    for (const std::int64_t point : scene.pins[i].points) {
      state.pin[static_cast<std::size_t>(point)] = static_cast<std::int32_t>(i);
    }
  }
  for (int y = 0; y < c.rows; ++y) {
    for (int x = 0; x < c.columns; ++x) {
      Vector at = c.origin + (x * right) * c.right + (y * down) * c.down;
      if (c.shake > 0) at += {shaken(), shaken(), shaken()};
      const bool free = state.pin[state.positions.size()] < 0;
      const sk::float3 p = toFloat3(at);
      state.positions.push_back({p.x, p.y, p.z, free ? 1.0f : 0.0f});
      const Vec<float> d = free ? start : Vec<float>{};
      const Vec<float> kept = scene.run.verlet == Verlet::Displacements ? d : vecOf<float>(p) - d;
      state.displacements.push_back({kept.x, kept.y, kept.z});
      state.alive.push_back(linksAt(x, y, c.columns, c.rows));
    }
  }
  return state;
}

}  // namespace examples
