// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "support/colormap.hpp"
#include "support/host_memory.hpp"
#include "support/scene_file.hpp"

namespace fluid {

namespace {

using examples::Range;
using examples::SceneTable;

constexpr Range positive{1e-12, 1e12};
constexpr Range fromZero{0.0, 1e12};
constexpr Range anything{-1e12, 1e12};
constexpr std::int64_t mostCells = std::int64_t{1} << 26;

constexpr std::array<std::string_view, 5> sides = {"periodic", "wall", "slip", "inflow", "outflow"};
constexpr std::array<std::string_view, 6> velocityKeys = {
    "left_velocity", "right_velocity", "bottom_velocity", "top_velocity", "back_velocity", "front_velocity"};
constexpr std::array<std::string_view, 2> obstacleKinds = {"wall", "slip"};
constexpr std::array<std::string_view, 4> shownNames = {"smoke", "temperature", "vorticity", "speed"};

/// Two or three numbers; the third is 0 if it is missing.
std::optional<Triple> triple(const SceneTable& table, std::string_view key) {
  const auto numbers = table.numbers(key, -1, anything);
  if (!numbers) return std::nullopt;
  if (numbers->size() < 2 || numbers->size() > 3)
    table.refuse(key, "has two or three numbers, along x, y and z");
  return Triple{(*numbers)[0], (*numbers)[1], numbers->size() > 2 ? (*numbers)[2] : 0.0};
}

void readGrid(const SceneTable& table, const Overrides& overrides, Model& model) {
  const auto size = table.numbers("size", -1);
  if (!size) table.refuse("size", "is missing: cells along x, y and, in space, z");
  if (size->size() < 2 || size->size() > 3) table.refuse("size", "is width, height and, in space, depth");
  for (std::size_t d = 0; d < size->size(); ++d) {
    const double n = (*size)[d];
    if (n < 2 || n > 16384 || n != std::floor(n)) table.refuse("size", "takes whole numbers from 2 to 16384");
    model.cells[d] = static_cast<std::int64_t>(n);
  }
  model.spacing = table.number("spacing", positive).value_or(1.0 / static_cast<double>(model.cells[0]));
  if (!overrides.size.empty()) {
    if (overrides.size.size() != size->size())
      table.refuse("size", fmt::format("has {} extents, and --size {}", size->size(), overrides.size.size()));
    const double width = model.spacing * static_cast<double>(model.cells[0]);
    std::ranges::copy(overrides.size, model.cells.begin());
    model.spacing = width / static_cast<double>(model.cells[0]);
  }
  // The layer included; in three factors, none of which overflows.
  if ((model.cells[0] + 2) * (model.cells[1] + 2) * (model.cells[2] + 2) > mostCells)
    table.refuse("size", "makes more than 2^26 cells; take fewer");
  // What they are is kept in some bytes each, before there is a device.
  constexpr double unasked = 1 << 24;
  const double bytes =
      16.0 * static_cast<double>((model.cells[0] + 2) * (model.cells[1] + 2) * (model.cells[2] + 2));
  const std::optional<std::int64_t> available = examples::availableMemory();
  if (bytes > unasked && available && bytes > static_cast<double>(*available))
    table.refuse(
        "size",
        fmt::format(
            "makes cells that take more than {:.3g} GB of memory, and {:.3g} GB are available; take fewer",
            bytes * 1e-9, static_cast<double>(*available) * 1e-9));
}

void readSide(const SceneTable& table, std::size_t side, Model& model) {
  table.read(sideNames[side], model.sides[side], sides);
  const auto velocity = triple(table, velocityKeys[side]);
  const Side is = model.sides[side];
  if (is == Side::Inflow && !velocity)
    table.refuse(sideNames[side],
                 fmt::format("is an inflow without a velocity; give {}", velocityKeys[side]));
  if (!velocity) return;
  if (is != Side::Inflow && is != Side::Wall)
    table.refuse(velocityKeys[side],
                 fmt::format("is for a wall or an inflow, and {} is neither", sideNames[side]));
  const double across = (*velocity)[side / 2] * (side % 2 == 0 ? 1.0 : -1.0);
  if (is == Side::Inflow && across <= 0.0)
    table.refuse(velocityKeys[side], "does not point into the grid; what flows out takes an \"outflow\"");
  if (is == Side::Wall && across != 0.0)
    table.refuse(velocityKeys[side],
                 "goes through a wall, which moves along itself only; make it an \"inflow\"");
  model.sideVelocity[side] = *velocity;
}

void readBoundary(const SceneTable& table, Model& model) {
  for (std::size_t side = 0; side < 2 * static_cast<std::size_t>(model.rank()); ++side)
    readSide(table, side, model);
  for (std::size_t low = 0; low < 6; low += 2)
    if ((model.sides[low] == Side::Periodic) != (model.sides[low + 1] == Side::Periodic)) {
      const std::size_t closed = model.sides[low] == Side::Periodic ? low + 1 : low;
      table.refuse(sideNames[closed], fmt::format("is not periodic, but {} is; both are, or none",
                                                  sideNames[closed ^ std::size_t{1}]));
    }
  if (const auto kind = table.choice("obstacles", obstacleKinds)) model.obstaclesSlip = *kind == 1;
}

Shape readShape(const SceneTable& table) {
  const auto centre = triple(table, "centre"), low = triple(table, "low"), high = triple(table, "high");
  const auto radius = table.number("radius", positive);
  Shape shape;
  if (centre && radius && !low && !high) {
    shape.sphere = Sphere{*centre, *radius};
  } else if (low && high && !centre && !radius) {
    for (std::size_t d = 0; d < 2; ++d)
      if ((*low)[d] >= (*high)[d]) table.refuse("high", "is not above low");
    shape.brick = Brick{*low, *high};
  } else {
    table.fail("centre", "a shape is a centre and a radius, or the corners low and high");
  }
  return shape;
}

void readSources(const SceneTable& table, Model& model) {
  for (const SceneTable& t : table.tables("source")) {
    const auto smoke = t.number("smoke", Range{0.0, 1e6}), temperature = t.number("temperature", anything);
    if (!smoke && !temperature) t.refuse("smoke", "is missing; a source holds smoke, a temperature, or both");
    model.hasSmoke |= smoke.has_value();
    model.hasHeat |= temperature.has_value();
    model.sources.push_back({readShape(t), smoke.value_or(0.0), temperature.value_or(0.0)});
  }
}

void readBuoyancy(const SceneTable& table, Model& model) {
  Buoyancy b;
  table.read("lift", b.lift, anything);
  table.read("ambient", b.ambient, anything);
  table.read("sink", b.sink, anything);
  if (b.lift != 0.0 && !model.hasHeat) table.refuse("lift", "acts on temperatures, and no source has one");
  if (b.sink != 0.0 && !model.hasSmoke) table.refuse("sink", "acts on smoke, and no source has any");
  model.buoyancy = b;
}

void readViscosity(const SceneTable& table, Model& model) {
  Viscosity v;
  const auto value = table.number("value", fromZero);
  if (!value) table.refuse("value", "is missing: the kinematic viscosity");
  v.value = *value;
  table.read("implicit", v.isImplicit);
  if (v.isImplicit && model.scheme == Scheme::Central)
    table.refuse("implicit",
                 "goes with the other schemes; central differences take the viscosity explicitly");
  if (v.value > 0.0) model.viscosity = v;
}

void readRun(const SceneTable& table, Scene& scene) {
  Model& model = scene.model;
  table.read("steps", scene.steps, Range{1, 1e9});
  model.cfl = table.number("cfl", Range{1e-6, 100.0}).value_or(model.scheme == Scheme::Central ? 0.7 : 1.5);
  model.timeStep = table.number("time_step", positive);
  table.read("tolerance", model.tolerance, Range{1e-12, 0.1});
  table.read("projection", model.projector, projectorNames);
  table.read("most_iterations", model.mostIterations, Range{1, 1e6});
  model.precision = table.precision("precision", examples::commonPrecisions).value_or(model.precision);
  if (!model.timeStep || !model.viscosity || model.viscosity->isImplicit) return;
  const double longest = model.spacing * model.spacing / (2.0 * model.rank() * model.viscosity->value);
  if (*model.timeStep > longest)
    table.refuse(
        "time_step",
        fmt::format(
            "{:g} is not stable: viscosity allows {:.6g} (h^2 / ({} viscosity)); take a smaller one, or "
            "implicit = true in [viscosity]",
            *model.timeStep, longest, 2 * model.rank()));
}

void readView(const SceneTable& table, Scene& scene) {
  View& v = scene.view;
  const Model& model = scene.model;
  table.read("field", v.shown, shownNames);
  if ((v.shown == Shown::Smoke && !model.hasSmoke) || (v.shown == Shown::Temperature && !model.hasHeat))
    table.refuse("field", fmt::format("'{}' is not in this scene: no source has any",
                                      shownNames[static_cast<std::size_t>(v.shown)]));
  if (model.isSpace() && v.shown != Shown::Smoke)
    table.refuse("field", "is of planes; in space, smoke is drawn");
  examples::readFieldView(table, v);
  try {
    examples::colormap(v.colours, 2);
  } catch (const std::exception& error) {
    table.fail("colours", error.what());
  }
  table.read("turn", v.turn, Range{-10.0, 10.0});
  table.read("tilt", v.tilt, Range{0.02, 1.5});
  table.read("thickness", v.thickness, Range{1e-3, 1e4});
  table.read("glows", v.glows);
  if (v.glows && !model.hasHeat) table.refuse("glows", "is of heat, and no source has a temperature");
}

/// What is lighter than the middle grey of a picture, or more than 1/2 in an array, is an obstacle.
void readMask(const SceneTable& table, const std::filesystem::path& folder, Model& model) {
  const std::vector<double> values = examples::readField(table, "mask", folder, model.cells);
  model.mask.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) model.mask[i] = model.mask[i] || values[i] > 0.5;
}

Initial readInitial(const SceneTable& table, const std::filesystem::path& folder, Model& model) {
  Initial i;
  i.velocity = triple(table, "velocity").value_or(i.velocity);
  table.read("noise", i.noise, fromZero);
  table.read("random", i.random, Range{0, 4294967295.0});
  i.smoke = examples::readField(table, "smoke_file", folder, model.cells);
  i.heat = examples::readField(table, "temperature_file", folder, model.cells);
  model.hasSmoke |= !i.smoke.empty();
  model.hasHeat |= !i.heat.empty();
  return i;
}

}  // namespace

Scene readScene(const std::filesystem::path& file, const Overrides& overrides) {
  const SceneTable table = examples::loadScene(file);
  Scene scene;
  Model& model = scene.model;
  scene.name = file.stem().string();
  scene.title = table.text("title").value_or(scene.name);
  if (const auto t = table.table("grid"))
    readGrid(*t, overrides, model);
  else
    table.refuse("grid", "is missing: the table [grid] has the size");
  for (std::size_t side = 0; side < 2 * static_cast<std::size_t>(model.rank()); ++side)
    model.sides[side] = Side::Wall;
  if (const auto t = table.table("convection")) t->read("scheme", model.scheme, schemeNames);
  model.scheme = overrides.scheme.value_or(model.scheme);
  if (const auto t = table.table("boundary")) readBoundary(*t, model);
  const std::filesystem::path folder = file.parent_path();
  for (const SceneTable& t : table.tables("obstacle")) {
    if (t.has("mask"))
      readMask(t, folder, model);
    else
      model.obstacles.push_back(readShape(t));
  }
  readSources(table, model);
  if (const auto t = table.table("initial")) scene.initial = readInitial(*t, folder, model);
  if (const auto t = table.table("viscosity")) readViscosity(*t, model);
  if (const auto t = table.table("buoyancy")) readBuoyancy(*t, model);
  if (const auto t = table.table("force")) model.force = triple(*t, "acceleration").value_or(model.force);
  if (const auto t = table.table("run")) readRun(*t, scene);
  scene.steps = overrides.steps.value_or(scene.steps);
  model.precision = overrides.precision.value_or(model.precision);
  model.projector = overrides.projector.value_or(model.projector);
  scene.record = examples::readRecord(table.table("record"), scene.name);
  scene.view.shown = model.hasSmoke ? Shown::Smoke : Shown::Speed;
  if (const auto t = table.table("view")) readView(*t, scene);
  if (model.isSpace() && !model.hasSmoke && !scene.record.output.empty())
    table.refuse("source", "is missing: a picture in space shows smoke; or say output = \"\" in [record]");
  table.finish();
  if (const std::string wrong = contradiction(model); !wrong.empty()) {
    const char* key = wrong.starts_with("leave") ? "obstacle" : "boundary";
    table.fail(key,
               fmt::format("{} {}", wrong.starts_with("leave") ? "the obstacles" : "the boundary", wrong));
  }
  return scene;
}

}  // namespace fluid
