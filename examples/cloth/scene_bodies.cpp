// SPDX-License-Identifier: MIT
#include "scene_bodies.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace examples {
namespace {

constexpr Range length{1e-6, 1e6};

Vector needed(const SceneTable& t, std::string_view key, std::optional<Vector> value) {
  if (!value) t.fail(key, fmt::format("'{}' is missing; say where, as [x, y, z]", key));
  return *value;
}

double radiusOf(const SceneTable& t) {
  const auto radius = t.number("radius", length);
  if (!radius) t.fail("radius", "'radius' is missing; say it in metres");
  return *radius;
}

/// What all kinds of bodies have.
Body bodyOf(const SceneTable& t, Kind kind) {
  Body b;
  b.kind = kind;
  b.friction = t.number("friction", {0.0, 100.0}).value_or(b.friction);
  b.swing = vectorOf(t, "swing").value_or(Vector{});
  b.period = t.number("period", {1e-6, 1e9}).value_or(b.period);
  b.colour = colourOf(t, "colour").value_or(b.colour);
  return b;
}

Body sphereOf(const SceneTable& t) {
  Body b = bodyOf(t, Kind::Sphere);
  b.at = needed(t, "centre", vectorOf(t, "centre"));
  b.size.x = radiusOf(t);
  return b;
}

Body planeOf(const SceneTable& t) {
  Body b = bodyOf(t, Kind::Plane);
  b.at = needed(t, "through", vectorOf(t, "through"));
  b.along = directionOf(t, "normal").value_or(Vector{0, 1, 0});
  return b;
}

Body capsuleOf(const SceneTable& t) {
  Body b = bodyOf(t, Kind::Capsule);
  b.at = needed(t, "from", vectorOf(t, "from"));
  b.along = needed(t, "to", vectorOf(t, "to")) - b.at;
  b.size.x = radiusOf(t);
  return b;
}

Body boxOf(const SceneTable& t) {
  Body b = bodyOf(t, Kind::Box);
  b.at = needed(t, "centre", vectorOf(t, "centre"));
  const auto size = t.numbers("size", 3, length);
  if (!size) t.fail("size", "'size' is missing; say it in metres, as [x, y, z]");
  b.size = 0.5 * Vector{(*size)[0], (*size)[1], (*size)[2]};
  const double half = t.number("turned", {-360, 360}).value_or(0.0) * std::numbers::pi / 360.0;
  b.axis = std::sin(half) * directionOf(t, "axis").value_or(Vector{0, 1, 0});
  b.turn = std::cos(half);
  return b;
}

/// Every n-th point of a line of them, the last one, too.
void addLine(std::vector<std::int64_t>& points, std::int64_t begin, std::int64_t stride, int count,
             int every) {
  for (int i = 0; i < count; i += every) points.push_back(begin + i * stride);
  if ((count - 1) % every != 0) points.push_back(begin + (count - 1) * stride);
}

void addEdge(std::vector<std::int64_t>& points, std::size_t edge, const Cloth& c, int every) {
  const std::int64_t columns = c.columns;
  if (edge == 0) addLine(points, 0, 1, c.columns, every);
  if (edge == 1) addLine(points, (c.rows - 1) * columns, 1, c.columns, every);
  if (edge == 2) addLine(points, 0, columns, c.rows, every);
  if (edge == 3) addLine(points, columns - 1, columns, c.rows, every);
}

Pin pinOf(const SceneTable& t, const Cloth& c) {
  Pin pin;
  constexpr std::array<std::string_view, 4> corners = {"top-left", "top-right", "bottom-left",
                                                       "bottom-right"};
  constexpr std::array<std::string_view, 4> edges = {"top", "bottom", "left", "right"};
  const std::int64_t columns = c.columns;
  if (const auto corner = t.choice("corner", corners)) {
    pin.points.push_back((*corner < 2 ? 0 : c.rows - 1) * columns + (*corner % 2 == 0 ? 0 : columns - 1));
  }
  const int every = static_cast<int>(t.integer("every", {1, 1e6}).value_or(1));
  if (const auto edge = t.choice("edge", edges)) addEdge(pin.points, *edge, c, every);
  if (const auto point = t.numbers("point", 2, {0, 1 << 15})) {
    const auto x = static_cast<std::int64_t>((*point)[0]), y = static_cast<std::int64_t>((*point)[1]);
    if (x >= columns || y >= c.rows) {
      t.fail("point",
             fmt::format("there are {} columns and {} rows of points, counted from 0", c.columns, c.rows));
    }
    pin.points.push_back(y * columns + x);
  }
  if (pin.points.empty()) t.fail("corner", "a pin holds a 'corner', an 'edge' or a 'point'");
  pin.carry = vectorOf(t, "carry").value_or(Vector{});
  if (const auto during = t.numbers("during", 2, {0.0, 1e9})) {
    pin.begin = (*during)[0];
    pin.end = (*during)[1];
    if (pin.end <= pin.begin) t.fail("during", "the end is not after the beginning");
  } else if (pin.carry != Vector{}) {
    t.fail("carry", "say when, by during = [begin, end] in seconds");
  }
  return pin;
}

}  // namespace

std::optional<Vector> vectorOf(const SceneTable& table, std::string_view key) {
  const auto v = table.numbers(key, 3, {-1e30, 1e30});
  if (!v) return std::nullopt;
  return Vector{(*v)[0], (*v)[1], (*v)[2]};
}

std::optional<Vector> directionOf(const SceneTable& table, std::string_view key) {
  const auto v = vectorOf(table, key);
  if (v && !(examples::length(*v) > 0))
    table.fail(key, fmt::format("'{}' is a direction and cannot be zero", key));
  return v ? std::optional(normalized(*v)) : std::nullopt;
}

std::optional<Vector> colourOf(const SceneTable& table, std::string_view key) {
  const auto v = table.numbers(key, 3, {0.0, 1.0});
  if (!v) return std::nullopt;
  return Vector{(*v)[0], (*v)[1], (*v)[2]};
}

std::vector<Pin> pinsOf(const SceneTable& scene, const Cloth& cloth) {
  std::vector<Pin> pins;
  std::size_t held = 0;
  for (const SceneTable& table : scene.tables("pin")) {
    pins.push_back(pinOf(table, cloth));
    held += pins.back().points.size();
    // each point may be that of two edges, a corner, and itself
    if (held >
        std::size_t{4} * static_cast<std::size_t>(cloth.columns) * static_cast<std::size_t>(cloth.rows))
      table.fail("edge", "the pins hold points over and over again; name each edge once");
  }
  return pins;
}

std::vector<Body> bodiesOf(const SceneTable& scene) {
  std::vector<Body> bodies;
  for (const SceneTable& t : scene.tables("sphere")) bodies.push_back(sphereOf(t));
  for (const SceneTable& t : scene.tables("plane")) bodies.push_back(planeOf(t));
  for (const SceneTable& t : scene.tables("capsule")) bodies.push_back(capsuleOf(t));
  for (const SceneTable& t : scene.tables("box")) bodies.push_back(boxOf(t));
  return bodies;
}

Vector Body::shift(double time) const {
  if (swing == Vector{}) return {};
  return std::sin(2.0 * std::numbers::pi * time / period) * swing;
}

}  // namespace examples
