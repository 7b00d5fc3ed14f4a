// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "support/scene_file.hpp"

namespace examples {
namespace {

constexpr Range positive{1e-9, 1e9};
constexpr Range notNegative{0.0, 1e9};

/// Reads a vector of unit length.
void readDirection(const SceneTable& t, std::string_view key, Vector& value) {
  value = t.direction(key).value_or(value);
}

/// Reads red, green and blue from 0 to 1, sRGB-encoded.
void readColour(const SceneTable& t, std::string_view key, Vector& value) {
  if (const auto v = t.numbers(key, 3, {0.0, 1.0})) value = {(*v)[0], (*v)[1], (*v)[2]};
}

Cloth clothOf(const SceneTable& t) {
  Cloth c;
  if (const auto points = t.numbers("points", 2, {1, 1 << 15})) {
    c.columns = static_cast<int>((*points)[0]);
    c.rows = static_cast<int>((*points)[1]);
    if (c.columns != (*points)[0] || c.rows != (*points)[1])
      t.fail("points", "columns and rows are whole numbers");
  }
  if (std::int64_t{c.columns} * c.rows > std::int64_t{1} << 26) {
    t.fail("points", "more than 2^26 points; that many do not fit here");
  }
  if (const auto size = t.numbers("size", 2, positive)) {
    c.width = (*size)[0];
    c.height = (*size)[1];
  }
  t.read("mass", c.mass, positive);
  t.read("rest", c.rest, {0.0, 100.0});
  t.read("origin", c.origin);
  readDirection(t, "right", c.right);
  readDirection(t, "down", c.down);
  t.read("shake", c.shake, notNegative);
  t.read("seed", c.seed, {0, 4294967295.0});
  return c;
}

LinkSettings linksOf(const SceneTable& scene) {
  LinkSettings links;
  const auto relaxed = scene.table("constraints");
  const auto springs = scene.table("springs");
  if (relaxed && springs)
    scene.fail("springs", "links are constraints or springs, not both; leave one of the tables out");
  const auto& t = relaxed ? relaxed : springs;
  if (!t) return links;
  links.springs = springs.has_value();
  const Range stiffness = links.springs ? notNegative : Range{0.0, 1.0};
  links.structural = t->number("structural", stiffness);
  links.shear = t->number("shear", stiffness);
  links.bend = t->number("bend", stiffness);
  constexpr std::array<std::string_view, 2> laws = {"exact", "jakobsen"};
  t->read("law", links.law, laws);
  if (relaxed) {
    t->read("iterations", links.iterations, {1, 10000});
    t->read("relaxation", links.relaxation, {0.0, 16.0});
  }
  return links;
}

WindSettings windOf(const SceneTable& t) {
  WindSettings w;
  t.read("velocity", w.velocity);
  t.read("density", w.density, notNegative);
  t.read("across", w.across, notNegative);
  t.read("along", w.along, notNegative);
  t.read("gust", w.gust, {0.0, 10.0});
  t.read("swirl", w.swirl, {0.0, 10.0});
  t.read("period", w.period, positive);
  t.read("wavelength", w.wavelength, positive);
  return w;
}

RunSettings runOf(const SceneTable& t) {
  RunSettings r;
  t.read("dt", r.dt, {1e-9, 10.0});
  t.read("steps", r.steps, {1, 1e12});
  constexpr std::array<std::string_view, 2> forms = {"displacements", "positions"};
  t.read("verlet", r.verlet, forms);
  r.untilSettled = t.number("until_settled", positive);
  t.read("check_every", r.checkEvery, {1, 1e6});
  return r;
}

void readRecord(const SceneTable& t, RecordSettings& r) {
  t.read("frames", r.frames, {1, 1e6});
  r.framesPerSecond =
      static_cast<int>(std::lround(t.number("frames_per_second", {1, 1000}).value_or(r.framesPerSecond)));
  r.output = t.text("film").value_or("");
  r.csv = t.text("csv").value_or("");
  t.read("obj", r.obj);
}

ViewSettings viewOf(const SceneTable& t) {
  ViewSettings v;
  t.read("eye", v.eye);
  t.read("at", v.at);
  if (v.eye == v.at) t.fail("eye", "the eye is where it looks at; move one of them");
  t.read("field_of_view", v.fieldOfView, {1, 120});
  readDirection(t, "light", v.light);
  readColour(t, "front", v.front);
  readColour(t, "back", v.back);
  readColour(t, "second", v.second);
  readColour(t, "background", v.background);
  readColour(t, "ground", v.ground);
  constexpr std::array<std::string_view, 5> patterns = {"plain", "stripes", "checks", "grid", "harlequin"};
  v.pattern = static_cast<int>(t.choice("pattern", patterns).value_or(0));
  t.read("repeats", v.repeats, {0.5, 1000});
  v.floor = t.number("floor");
  return v;
}

constexpr Range bodyLength{1e-6, 1e6};

Vector needed(const SceneTable& t, std::string_view key) {
  const auto value = t.vector(key);
  if (!value) t.fail(key, fmt::format("'{}' is missing; say where, as [x, y, z]", key));
  return *value;
}

double radiusOf(const SceneTable& t) {
  const auto radius = t.number("radius", bodyLength);
  if (!radius) t.fail("radius", "'radius' is missing; say it in metres");
  return *radius;
}

/// What all kinds of bodies have.
Body bodyOf(const SceneTable& t, Kind kind) {
  Body b;
  b.kind = kind;
  t.read("friction", b.friction, {0.0, 100.0});
  t.read("swing", b.swing);
  t.read("period", b.period, {1e-6, 1e9});
  readColour(t, "colour", b.colour);
  return b;
}

Body sphereOf(const SceneTable& t) {
  Body b = bodyOf(t, Kind::Sphere);
  b.at = needed(t, "centre");
  b.size.x = radiusOf(t);
  return b;
}

Body planeOf(const SceneTable& t) {
  Body b = bodyOf(t, Kind::Plane);
  b.at = needed(t, "through");
  b.along = t.direction("normal").value_or(Vector{0, 1, 0});
  return b;
}

Body capsuleOf(const SceneTable& t) {
  Body b = bodyOf(t, Kind::Capsule);
  b.at = needed(t, "from");
  b.along = needed(t, "to") - b.at;
  b.size.x = radiusOf(t);
  return b;
}

Body boxOf(const SceneTable& t) {
  Body b = bodyOf(t, Kind::Box);
  b.at = needed(t, "centre");
  const auto size = t.numbers("size", 3, bodyLength);
  if (!size) t.fail("size", "'size' is missing; say it in metres, as [x, y, z]");
  b.size = 0.5 * Vector{(*size)[0], (*size)[1], (*size)[2]};
  const double half = t.number("turned", {-360, 360}).value_or(0.0) * std::numbers::pi / 360.0;
  b.axis = std::sin(half) * t.direction("axis").value_or(Vector{0, 1, 0});
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
  t.read("carry", pin.carry);
  if (const auto during = t.numbers("during", 2, {0.0, 1e9})) {
    pin.begin = (*during)[0];
    pin.end = (*during)[1];
    if (pin.end <= pin.begin) t.fail("during", "the end is not after the beginning");
  } else if (pin.carry != Vector{}) {
    t.fail("carry", "say when, by during = [begin, end] in seconds");
  }
  return pin;
}

/// One pin for each table [[pin]].
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

/// One body for each table [[sphere]], [[plane]], [[capsule]] and [[box]].
std::vector<Body> bodiesOf(const SceneTable& scene) {
  std::vector<Body> bodies;
  for (const SceneTable& t : scene.tables("sphere")) bodies.push_back(sphereOf(t));
  for (const SceneTable& t : scene.tables("plane")) bodies.push_back(planeOf(t));
  for (const SceneTable& t : scene.tables("capsule")) bodies.push_back(capsuleOf(t));
  for (const SceneTable& t : scene.tables("box")) bodies.push_back(boxOf(t));
  return bodies;
}

}  // namespace

Vector Body::shift(double time) const {
  if (swing == Vector{}) return {};
  return std::sin(2.0 * std::numbers::pi * time / period) * swing;
}

bool Scene::has(Kind kind) const {
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body& b) { return b.kind == kind; });
}

Scene readScene(const std::filesystem::path& file, const std::optional<Points>& points) {
  const SceneTable t = loadScene(file);
  Scene scene;
  scene.title = t.text("title").value_or(file.stem().string());
  t.read("subtitle", scene.subtitle);
  const auto cloth = t.table("cloth");
  if (!cloth) t.fail("cloth", "a scene needs a table [cloth], with the points, size and place of one");
  scene.cloth = clothOf(*cloth);
  if (points) {
    scene.cloth.columns = points->columns;
    scene.cloth.rows = points->rows;
  }
  scene.links = linksOf(t);
  if (const auto tear = t.table("tear")) {
    scene.tear = tear->number("strain", {1e-6, 1e6});
    if (!scene.tear) tear->fail("strain", "say at which strain links tear: 0.3 is 30 % longer than at rest");
  }
  if (const auto gravity = t.table("gravity")) {
    scene.gravity = gravity->vector("acceleration").value_or(Vector{0, -9.81, 0});
  }
  if (const auto air = t.table("air")) air->read("damping", scene.damping, {0.0, 1e6});
  if (const auto wind = t.table("wind")) scene.wind = windOf(*wind);
  scene.pins = pinsOf(t, scene.cloth);
  scene.bodies = bodiesOf(t);
  if (const auto contact = t.table("contact")) contact->read("thickness", scene.thickness, {0.0, 1e3});
  if (const auto run = t.table("run")) scene.run = runOf(*run);
  if (scene.run.verlet == Verlet::Positions && !scene.bodies.empty()) {
    t.fail("run", "bodies change displacements; take verlet = \"displacements\" in a scene that has any");
  }
  if (const auto record = t.table("record")) readRecord(*record, scene.record);
  if (const auto view = t.table("view")) scene.view = viewOf(*view);
  t.finish();
  return scene;
}

}  // namespace examples
