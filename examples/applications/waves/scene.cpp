// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "support/scene_file.hpp"

namespace waves {

namespace {

using examples::Range;
using examples::SceneTable;

constexpr Range positive{1e-12, 1e12};
constexpr std::int64_t mostCells = std::int64_t{1} << 26;

void readWater(const SceneTable& table, const Overrides& overrides, Model& m) {
  const auto size = table.numbers("size", 2);
  if (!size) table.refuse("size", "is missing: cells along x and y");
  for (const double n : *size)
    if (n < 2 || n > 16384 || n != std::floor(n)) table.refuse("size", "takes whole numbers from 2 to 16384");
  m.width = static_cast<std::int64_t>((*size)[0]);
  m.height = static_cast<std::int64_t>((*size)[1]);
  const double width = table.number("width", positive).value_or(1.0);
  if (!overrides.size.empty()) {
    m.width = overrides.size[0];
    m.height = overrides.size[1];
  }
  if (m.width * m.height > mostCells) table.refuse("size", "makes more than 2^26 cells; take fewer");
  m.spacing = width / static_cast<double>(m.width);
  table.read("speed", m.speed, positive);
}

void readRun(const SceneTable& table, Scene& scene) {
  Model& m = scene.model;
  table.read("steps", scene.steps, Range{1, 1e9});
  table.read("time_step", m.timeStep, positive);
  table.read("scheme", m.scheme, schemeNames);
  table.read("tolerance", m.tolerance, Range{1e-15, 0.1});
  table.read("most_iterations", m.mostIterations, Range{1, 1e6});
  m.precision = table.precision("precision", examples::commonPrecisions).value_or(m.precision);
}

Drop readDrop(const SceneTable& table) {
  const auto centre = table.numbers("centre", 2, Range{-1e12, 1e12});
  if (!centre) table.refuse("centre", "is missing: where the drop falls, x and y");
  const auto radius = table.number("radius", positive);
  const auto depth = table.number("depth", Range{-1e6, 1e6});
  const auto time = table.number("time", Range{0.0, 1e12});
  if (!radius) {
    table.finish();  // a misspelt key is the better message
    table.refuse("radius", "of the drop is missing");
  }
  return {.x = (*centre)[0],
          .y = (*centre)[1],
          .radius = *radius,
          .depth = depth.value_or(0.2 * *radius),
          .time = time.value_or(0.0)};
}

void readView(const SceneTable& table, View& v) {
  if (const auto pixels = table.numbers("pixels", 2)) {
    for (const double n : *pixels)
      if (n < 16 || n > 8192 || n != std::floor(n))
        table.refuse("pixels", "takes whole numbers from 16 to 8192");
    v.width = static_cast<int>((*pixels)[0]);
    v.height = static_cast<int>((*pixels)[1]);
  }
  table.read("turn", v.turn, Range{-10.0, 10.0});
  table.read("tilt", v.tilt, Range{0.15, 1.5});
  table.read("distance", v.distance, Range{0.2, 10.0});
  table.read("depth", v.depth, Range{0.01, 4.0});
  table.read("tiles", v.tiles, Range{1.0, 200.0});
  table.read("exaggeration", v.exaggeration, Range{0.0, 100.0});
}

}  // namespace

Scene readScene(const std::filesystem::path& file, const Overrides& overrides) {
  const SceneTable table = examples::loadScene(file);
  Scene scene;
  Model& m = scene.model;
  scene.name = file.stem().string();
  scene.title = table.text("title").value_or(scene.name);
  if (const auto t = table.table("water"))
    readWater(*t, overrides, m);
  else
    table.refuse("water", "is missing: the table [water] has the size");
  m.timeStep = m.spacing / m.speed;
  if (const auto t = table.table("run")) readRun(*t, scene);
  m.scheme = overrides.scheme.value_or(m.scheme);
  m.precision = overrides.precision.value_or(m.precision);
  scene.steps = overrides.steps.value_or(scene.steps);
  for (const SceneTable& t : table.tables("drop")) scene.drops.push_back(readDrop(t));
  if (const auto t = table.table("initial"))
    scene.heights = examples::readField(*t, "height_file", file.parent_path(), {m.width, m.height, 1});
  if (scene.drops.empty() && scene.heights.empty())
    table.refuse("drop", "is missing: without a [[drop]] the water stays flat");
  std::ranges::stable_sort(scene.drops, {}, &Drop::time);
  scene.record = examples::readRecord(table.table("record"), scene.name);
  if (const auto t = table.table("view")) readView(*t, scene.view);
  table.finish();
  if (!std::isfinite(static_cast<float>(m.lambdaSquared())) || m.lambdaSquared() > 1e8)
    table.fail("run",
               fmt::format("a time step of {:g} carries waves over more than 10000 cells; take a smaller "
                           "'time_step'",
                           m.timeStep));
  return scene;
}

void add(const Drop& drop, const Model& m, std::vector<double>& heights) {
  for (std::int64_t y = 0; y < m.height; ++y)
    for (std::int64_t x = 0; x < m.width; ++x) {
      const double dx = (static_cast<double>(x) + 0.5) * m.spacing - drop.x,
                   dy = (static_cast<double>(y) + 0.5) * m.spacing - drop.y;
      const double s = (dx * dx + dy * dy) / (drop.radius * drop.radius);
      heights[static_cast<std::size_t>(y * m.width + x)] -= drop.depth * (1.0 - s) * std::exp(-s);
    }
}

}  // namespace waves
