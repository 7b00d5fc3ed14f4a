// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "limits.hpp"
#include "patterns.hpp"
#include "support/scene_file.hpp"

namespace examples {
namespace {

constexpr Range positive{1e-12, 1e12};
constexpr Range fromZero{0.0, 1e12};
constexpr Range anything{-1e30, 1e30};

constexpr std::array<std::string_view, 3> edgeNames = {"wrap", "insulated", "wall"};
constexpr std::array<std::string_view, 3> densityNames = {"computed", "linear", "cubic"};
constexpr std::array<std::string_view, 2> profileNames = {"uniform", "conduction"};
constexpr std::array<std::string_view, 7> shownNames = {"temperature", "u",        "v",      "speed",
                                                        "vorticity",   "pressure", "bubbles"};

Grid readGrid(const SceneTable& table, const Overrides& overrides) {
  Grid grid;
  if (const auto size = table.numbers("size", -1)) {
    if (size->empty() || size->size() > 3) table.refuse("size", "is width, height and, in space, depth");
    const std::array<std::int64_t*, 3> extents = {&grid.width, &grid.height, &grid.depth};
    for (std::size_t i = 0; i < size->size(); ++i) {
      const double n = (*size)[i];
      if (n < 1 || n > 32768 || n != std::floor(n))
        table.refuse("size", "takes whole numbers from 1 to 32768");
      *extents[i] = static_cast<std::int64_t>(n);
    }
  }
  if (!overrides.size.empty()) grid.width = overrides.size[0];
  if (overrides.size.size() > 1) grid.height = overrides.size[1];
  if (overrides.size.size() > 2) grid.depth = overrides.size[2];
  if (grid.cells() > std::int64_t{1} << 28) table.refuse("size", "makes more than 2^28 cells; take fewer");
  table.read("spacing", grid.spacing, positive);
  return grid;
}

Boundary readBoundary(const SceneTable& table, bool isSpace) {
  Boundary b;
  Edge sides = Edge::Wrap;
  table.read("sides", sides, edgeNames);
  const std::array<std::string_view, 4> keys = {"left", "right", "bottom", "top"};
  const std::array<std::string_view, 4> warmths = {"left_temperature", "right_temperature",
                                                   "bottom_temperature", "top_temperature"};
  for (std::size_t side = 0; side < 4; ++side) {
    b.edges[side] = side < 2 ? sides : Edge::Wrap;
    table.read(keys[side], b.edges[side], edgeNames);
    const auto temperature = table.number(warmths[side], anything);
    if (temperature && b.edges[side] != Edge::Wall) {
      table.refuse(warmths[side], fmt::format("is only for a wall; say {} = \"wall\"", keys[side]));
    }
    if (!temperature && b.edges[side] == Edge::Wall) {
      table.refuse(keys[side], fmt::format("is a wall without a temperature; give {}", warmths[side]));
    }
    b.temperatures[side] = temperature.value_or(0.0);
  }
  const auto together = [&](std::size_t one, std::size_t other) {
    if ((b.edges[one] == Edge::Wrap) != (b.edges[other] == Edge::Wrap)) {
      table.refuse(keys[b.edges[one] == Edge::Wrap ? other : one],
                   fmt::format("is closed, but {} wraps; both sides wrap or none does",
                               keys[b.edges[one] == Edge::Wrap ? one : other]));
    }
  };
  together(Boundary::Left, Boundary::Right);
  together(Boundary::Bottom, Boundary::Top);
  if (isSpace) {
    if (b.edges[Boundary::Left] == Edge::Wall || b.edges[Boundary::Right] == Edge::Wall)
      table.refuse("sides",
                   "has walls, which a lattice in space has at the bottom and top only; insulate it");
    if (b.edges[Boundary::Left] != b.edges[Boundary::Right])
      table.refuse("left", "differs from right; in space, both are alike");
    b.closedZ = b.closedX();
  }
  return b;
}

Diffusion readDiffusion(const SceneTable& table, const Model& model) {
  const auto rate = table.number("rate", fromZero);
  const auto epsilon = table.number("epsilon", Range{0.0, 1e6});
  if (rate && epsilon) table.refuse("epsilon", "says the same as rate; give one of them");
  if (!rate && !epsilon)
    table.refuse("rate", "is missing; give rate, or epsilon, the part of a cell that a step mixes");
  const double h = model.grid.spacing;
  const double neighbours = model.grid.isSpace() ? 6.0 : 4.0;
  return {rate ? *rate : *epsilon * h * h / (neighbours * model.timeStep)};
}

Buoyancy readBuoyancy(const SceneTable& table) {
  Buoyancy b;
  b.sigma = table.number("sigma", Range{-1.0, 1.0}).value_or(0.1);
  b.alpha = table.number("alpha", Range{-1e6, 1e6}).value_or(1.0);
  table.read("tanh", b.density, densityNames);
  return b;
}

Reaction readReaction(const SceneTable& table) {
  Reaction r;
  const auto feed = table.number("feed", Range{0.0, 1.0}), kill = table.number("kill", Range{0.0, 1.0});
  if (const auto name = table.text("class")) {
    if (feed || kill) table.refuse("class", "sets feed and kill; give either it or them");
    try {
      const Pattern& pattern = findPattern(*name);
      r.feed = pattern.feed;
      r.kill = pattern.kill;
    } catch (const std::exception& error) {
      table.fail("class", error.what());
    }
  } else {
    if (!feed) table.refuse("feed", "is missing; give feed and kill, or a class of patterns");
    if (!kill) table.refuse("kill", "is missing; give feed and kill, or a class of patterns");
    r.feed = *feed;
    r.kill = *kill;
  }
  table.read("diffusion_u", r.diffusionU, fromZero);
  table.read("diffusion_v", r.diffusionV, fromZero);
  table.read("spacing", r.spacing, positive);
  table.read("time_step", r.timeStep, fromZero);
  table.read("stirring", r.stirring, anything);
  return r;
}

void readFlow(const SceneTable& table, Model& model) {
  if (model.grid.isSpace())
    table.refuse("rayleigh", "is of a flow, which only a plane lattice has; give two extents");
  const auto rayleigh = table.number("rayleigh", Range{1e-6, 1e12});
  if (!rayleigh)
    table.refuse("rayleigh", "is missing: buoyancy over friction and conduction; 1708 is where rolls begin");
  const double prandtl = table.number("prandtl", Range{1e-3, 1e4}).value_or(0.71);
  const double sound = table.number("sound", Range{1e-3, 1e6}).value_or(3.0);
  const bool slip = table.flag("slip").value_or(false);
  const auto wall = [&](Boundary::Side side) { return model.boundary.edges[side] == Edge::Wall; };
  if (!(wall(Boundary::Bottom) && wall(Boundary::Top)) && !(wall(Boundary::Left) && wall(Boundary::Right)))
    table.refuse("rayleigh", "needs two walls that face each other; give bottom and top, or left and right");
  if (!model.boundary.closedY()) table.refuse("rayleigh", "needs a floor; close bottom and top");
  setConvection(model, *rayleigh, prandtl, sound, slip);
}

Initial readInitial(const SceneTable& table, const Model& model, const std::filesystem::path& folder) {
  Initial i;
  table.read("profile", i.profile, profileNames);
  table.read("temperature", i.temperature, anything);
  table.read("noise", i.noise, fromZero);
  table.read("rolls", i.rolls, Range{0.0, 1e4});
  table.read("blobs", i.blobs, Range{0, 1e4});
  table.read("blob_radius", i.blobRadius, positive);
  table.read("blob_temperature", i.blobTemperature, anything);
  table.read("seeds", i.seeds, Range{0, 1e6});
  table.read("seed_side", i.seedSide, Range{1, 1e4});
  table.read("u", i.u, anything);
  table.read("v", i.v, anything);
  table.read("random", i.random, Range{0, 4294967295.0});
  const std::array<std::int64_t, 3> cells = {model.grid.width, model.grid.height, model.grid.depth};
  i.temperatureField = readField(table, "temperature_file", folder, cells);
  i.uField = readField(table, "u_file", folder, cells);
  i.vField = readField(table, "v_file", folder, cells);
  if (!i.temperatureField.empty() && !model.hasTemperature())
    table.refuse("temperature_file", "is for a scene with a temperature");
  if (!model.reaction && !i.uField.empty()) table.refuse("u_file", "is for a scene with a [reaction]");
  if (!model.reaction && !i.vField.empty()) table.refuse("v_file", "is for a scene with a [reaction]");
  return i;
}

Shown usuallyShown(const Model& model) {
  return model.reaction ? Shown::V : model.grid.isSpace() ? Shown::Bubbles : Shown::Temperature;
}

void readView(const SceneTable& table, const Model& model, View& v) {
  table.read("field", v.shown, shownNames);
  if (!has(model, v.shown)) {
    table.refuse("field", fmt::format("'{}' is not in this scene, whose operators do not make it",
                                      shownNames[static_cast<std::size_t>(v.shown)]));
  }
  readFieldView(table, v);
  table.read("relief", v.relief, Range{0.0, 1000.0});
  table.read("mirror", v.mirror);
}

void refuseUnstable(const SceneTable& run, const Model& model) {
  for (const Limit& limit : limitsOf(model)) {
    if (limit.holds()) continue;
    run.refuse("time_step", fmt::format("{:g} is not stable: {} allows {:.6g} ({}); take a smaller one",
                                        limit.chosen, limit.of, limit.largest, limit.formula));
  }
}

}  // namespace

bool has(const Model& model, Shown shown) {
  switch (shown) {
    case Shown::Temperature: return model.hasTemperature();
    case Shown::Bubbles: return model.hasTemperature() && model.grid.isSpace();
    case Shown::U:
    case Shown::V: return model.reaction.has_value();
    case Shown::Speed:
    case Shown::Vorticity:
    case Shown::Pressure: return model.flow.has_value();
  }
  return false;
}

std::string_view nameOf(Shown shown) { return shownNames[static_cast<std::size_t>(shown)]; }

Scene readScene(const std::filesystem::path& file, const Overrides& overrides) {
  const SceneTable table = loadScene(file);
  Scene scene;
  Model& model = scene.model;
  scene.name = file.stem().string();
  scene.title = table.text("title").value_or(scene.name);
  if (const auto grid = table.table("grid"))
    model.grid = readGrid(*grid, overrides);
  else
    table.refuse("grid", "is missing: the table [grid] has the size");
  if (const auto boundary = table.table("boundary"))
    model.boundary = readBoundary(*boundary, model.grid.isSpace());

  const auto run = table.table("run");
  if (!run) table.refuse("run", "is missing: the table [run] has the steps");
  run->read("steps", scene.steps, Range{1, 1e12});
  scene.steps = overrides.steps.value_or(scene.steps);
  const auto timeStep = run->number("time_step", fromZero);
  model.timeStep = timeStep.value_or(1.0);
  model.precision = run->precision("precision", precisionNames).value_or(model.precision);
  model.precision = overrides.precision.value_or(model.precision);
  if (const auto settling = run->table("until_settled")) {
    scene.settling.emplace();
    settling->read("tolerance", scene.settling->tolerance, fromZero);
    settling->read("every", scene.settling->every, Range{1, 1e9});
  }
  if (overrides.settle) {
    if (!scene.settling) scene.settling.emplace();
    scene.settling->tolerance = *overrides.settle;
  }

  if (const auto t = table.table("diffusion")) model.diffusion = readDiffusion(*t, model);
  table.read("boiling_point", model.boilingPoint, anything);
  if (const auto t = table.table("buoyancy")) model.buoyancy = readBuoyancy(*t);
  if (const auto t = table.table("latent_heat")) {
    model.latentHeat = LatentHeat{t->number("eta", anything).value_or(0.0)};
  }
  if (const auto t = table.table("reaction")) model.reaction = readReaction(*t);
  if (model.reaction && model.grid.isSpace())
    table.refuse("reaction", "is for a plane lattice; give two extents");
  if (const auto t = table.table("flow")) {
    if (model.diffusion) table.refuse("diffusion", "follows from the numbers of the flow; leave it out");
    readFlow(*t, model);
    if (!timeStep) {
      for (const Limit& limit : limitsOf(model))
        if (limit.of != "reaction") model.timeStep = std::min(model.timeStep, 0.8 * limit.largest);
    }
  }
  if (fieldsOf(model).empty()) {
    table.refuse(
        "grid",
        "has no operator to step it; add [diffusion], [buoyancy], [latent_heat], [reaction] or [flow]");
  }
  refuseUnstable(*run, model);

  if (const auto t = table.table("initial")) scene.initial = readInitial(*t, model, file.parent_path());
  const auto record = table.table("record");
  scene.record = readRecord(record, scene.name);
  if (record) record->read("every", scene.csvInterval, Range{1, 1e12});
  scene.view.shown = usuallyShown(model);
  if (const auto t = table.table("view")) readView(*t, model, scene.view);
  table.finish();
  return scene;
}

}  // namespace examples
