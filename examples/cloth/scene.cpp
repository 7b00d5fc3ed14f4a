// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "scene_bodies.hpp"
#include "support/scene_file.hpp"

namespace examples {
namespace {

constexpr Range positive{1e-9, 1e9};
constexpr Range notNegative{0.0, 1e9};

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
  c.mass = t.number("mass", positive).value_or(c.mass);
  c.rest = t.number("rest", {0.0, 100.0}).value_or(c.rest);
  c.origin = vectorOf(t, "origin").value_or(c.origin);
  c.right = directionOf(t, "right").value_or(c.right);
  c.down = directionOf(t, "down").value_or(c.down);
  c.shake = t.number("shake", notNegative).value_or(0.0);
  c.seed = static_cast<std::uint32_t>(t.integer("seed", {0, 4294967295.0}).value_or(1));
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
  if (const auto law = t->choice("law", laws)) links.law = static_cast<Law>(*law);
  if (relaxed) {
    links.iterations = static_cast<int>(t->integer("iterations", {1, 10000}).value_or(1));
    links.relaxation = t->number("relaxation", {0.0, 16.0}).value_or(1.0);
  }
  return links;
}

WindSettings windOf(const SceneTable& t) {
  WindSettings w;
  w.velocity = vectorOf(t, "velocity").value_or(Vector{});
  w.density = t.number("density", notNegative).value_or(w.density);
  w.across = t.number("across", notNegative).value_or(w.across);
  w.along = t.number("along", notNegative).value_or(w.along);
  w.gust = t.number("gust", {0.0, 10.0}).value_or(0.0);
  w.swirl = t.number("swirl", {0.0, 10.0}).value_or(0.0);
  w.period = t.number("period", positive).value_or(w.period);
  w.wavelength = t.number("wavelength", positive).value_or(w.wavelength);
  return w;
}

RunSettings runOf(const SceneTable& t) {
  RunSettings r;
  r.dt = t.number("dt", {1e-9, 10.0}).value_or(r.dt);
  r.steps = t.integer("steps", {1, 1e12}).value_or(r.steps);
  constexpr std::array<std::string_view, 2> forms = {"displacements", "positions"};
  if (const auto form = t.choice("verlet", forms)) r.verlet = static_cast<Verlet>(*form);
  r.untilSettled = t.number("until_settled", positive);
  r.checkEvery = static_cast<int>(t.integer("check_every", {1, 1e6}).value_or(r.checkEvery));
  return r;
}

RecordSettings recordOf(const SceneTable& t) {
  RecordSettings r;
  r.frames = static_cast<int>(t.integer("frames", {1, 1e6}).value_or(r.frames));
  r.framesPerSecond = t.number("frames_per_second", {1, 1000}).value_or(r.framesPerSecond);
  r.film = t.text("film").value_or("");
  r.csv = t.text("csv").value_or("");
  r.obj = t.text("obj").value_or("");
  return r;
}

ViewSettings viewOf(const SceneTable& t) {
  ViewSettings v;
  v.eye = vectorOf(t, "eye").value_or(v.eye);
  v.at = vectorOf(t, "at").value_or(v.at);
  if (v.eye == v.at) t.fail("eye", "the eye is where it looks at; move one of them");
  v.fieldOfView = t.number("field_of_view", {1, 120}).value_or(v.fieldOfView);
  v.light = directionOf(t, "light").value_or(v.light);
  v.front = colourOf(t, "front").value_or(v.front);
  v.back = colourOf(t, "back").value_or(v.back);
  v.second = colourOf(t, "second").value_or(v.second);
  v.background = colourOf(t, "background").value_or(v.background);
  v.ground = colourOf(t, "ground").value_or(v.ground);
  constexpr std::array<std::string_view, 5> patterns = {"plain", "stripes", "checks", "grid", "harlequin"};
  if (const auto pattern = t.choice("pattern", patterns)) v.pattern = static_cast<int>(*pattern);
  v.repeats = t.number("repeats", {0.5, 1000}).value_or(v.repeats);
  v.floor = t.number("floor");
  return v;
}

}  // namespace

bool Scene::has(Kind kind) const {
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body& b) { return b.kind == kind; });
}

Scene readScene(const std::filesystem::path& file, const std::optional<Points>& points) {
  const SceneTable t = loadScene(file);
  Scene scene;
  scene.title = t.text("title").value_or(file.stem().string());
  scene.subtitle = t.text("subtitle").value_or("");
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
    scene.gravity = vectorOf(*gravity, "acceleration").value_or(Vector{0, -9.81, 0});
  }
  if (const auto air = t.table("air")) scene.damping = air->number("damping", {0.0, 1e6}).value_or(0.0);
  if (const auto wind = t.table("wind")) scene.wind = windOf(*wind);
  scene.pins = pinsOf(t, scene.cloth);
  scene.bodies = bodiesOf(t);
  if (const auto contact = t.table("contact"))
    scene.thickness = contact->number("thickness", {0.0, 1e3}).value_or(0.0);
  if (const auto run = t.table("run")) scene.run = runOf(*run);
  if (scene.run.verlet == Verlet::Positions && !scene.bodies.empty()) {
    t.fail("run", "bodies change displacements; take verlet = \"displacements\" in a scene that has any");
  }
  if (const auto record = t.table("record")) scene.record = recordOf(*record);
  if (const auto view = t.table("view")) scene.view = viewOf(*view);
  t.finish();
  return scene;
}

}  // namespace examples
