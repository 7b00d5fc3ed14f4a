// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "camera.hpp"
#include "raster_file.hpp"
#include "scene_shapes.hpp"

namespace rays {
namespace {

using examples::Range;
using examples::SceneTable;

constexpr std::array<std::string_view, 5> scatteringNames = {"diffuse", "mirror", "glass", "metal",
                                                             "frosted"};
constexpr std::array<std::string_view, 2> lightNames = {"point", "sun"};
constexpr std::array<std::string_view, 2> toneNames = {"linear", "filmic"};
constexpr std::array<std::string_view, 2> samplingNames = {"random", "sobol"};
constexpr std::array<std::string_view, 3> strategyNames = {"both", "lights", "surfaces"};

Material readMaterial(const SceneTable& table, const Reading& reading, Model& model) {
  Material m;
  table.read("name", m.name);
  if (m.name.empty()) table.refuse("name", "is missing; things name their material by it");
  if (reading.materials.contains(m.name))
    table.refuse("name", fmt::format("'{}' is taken by another material", m.name));
  table.read("type", m.scattering, scatteringNames);
  const bool isClear = m.scattering == Scattering::Glass || m.scattering == Scattering::Frosted;
  const bool isRough = m.scattering == Scattering::Metal || m.scattering == Scattering::Frosted;
  const sk::float3 grey = {0.8f, 0.8f, 0.8f}, white = {1, 1, 1};
  m.colour = colourOf(table, "colour", isClear ? white : grey);
  if (std::max({m.colour.x, m.colour.y, m.colour.z}) > 1)
    table.refuse("colour", "has components from 0 to 1; what is brighter would make light");
  m.emission = colourOf(table, "emission", {0, 0, 0});
  table.read("both_sides", m.glowsBehind);
  if (isClear) m.ior = static_cast<float>(table.number("ior", Range{1.001, 4.0}).value_or(1.5));
  if (isRough) m.roughness = static_cast<float>(table.number("roughness", Range{1e-3, 1.0}).value_or(0.2));
  if (const auto file = table.text("texture")) {
    m.texture = static_cast<std::int32_t>(model.textures.size());
    model.textures.push_back(loadRaster(reading.folder / *file));
  }
  return m;
}

void readMaterials(const SceneTable& root, Reading& reading, Model& model) {
  for (const SceneTable& table : root.tables("material")) {
    model.materials.push_back(readMaterial(table, reading, model));
    reading.materials.emplace(model.materials.back().name,
                              static_cast<std::int32_t>(model.materials.size()) - 1);
  }
  if (model.materials.empty()) model.materials.push_back({.name = "grey"});
}

void readLights(const SceneTable& root, Model& model) {
  for (const SceneTable& table : root.tables("light")) {
    if (table.choice("type", lightNames).value_or(0) == 0) {
      model.points.push_back(
          {toFloat3(table.vector("position").value_or(Vector{})), colourOf(table, "intensity", {1, 1, 1})});
      continue;
    }
    const Vector towards = table.vector("towards").value_or(Vector{0, 1, 0});
    if (!(length(towards) > 0)) table.refuse("towards", "must not be zero");
    const double angle = table.number("angle", Range{0.0, 45.0}).value_or(0.27);
    model.suns.push_back({toFloat3(normalized(towards)), colourOf(table, "irradiance", {1, 1, 1}),
                          static_cast<float>(angle * std::numbers::pi / 180.0)});
  }
  if (model.points.size() + model.suns.size() > 64)
    root.fail("light", "a scene has 64 lights at most beside those that have a surface");
}

void readEnvironment(const SceneTable& root, const Reading& reading, Model& model) {
  const std::optional<SceneTable> table = root.table("environment");
  if (!table) return;
  const std::optional<std::string> image = table->text("image");
  model.environment.colour = colourOf(*table, "colour", image ? sk::float3{1, 1, 1} : sk::float3{0, 0, 0});
  if (image) model.environment.image = loadRaster(reading.folder / *image);
}

Camera readCamera(const SceneTable& root) {
  Camera camera;
  const std::optional<SceneTable> table = root.table("camera");
  if (!table) return camera;
  table->read("from", camera.from);
  table->read("to", camera.to);
  table->read("up", camera.up);
  table->read("field_of_view", camera.fieldOfView, Range{0.01, 179.0});
  table->read("lens", camera.lens, Range{0.0, 1e30});
  camera.focus = table->number("focus", positiveLength).value_or(length(camera.to - camera.from));
  if (camera.from == camera.to) table->refuse("to", "is the point 'from', so the camera looks nowhere");
  if (!(length(cross(normalized(camera.to - camera.from), normalized(camera.up))) > 1e-9))
    table->refuse("up", "is zero, or the direction in which the camera looks");
  return camera;
}

void readPicture(const SceneTable& root, const Overrides& overrides, Scene& scene) {
  Picture& picture = scene.picture;
  Output& output = scene.output;
  output.picture = scene.name + ".png";
  if (const std::optional<SceneTable> table = root.table("picture")) {
    if (const auto size = table->numbers("size", 2, Range{0, 32768})) {
      picture.width = static_cast<int>((*size)[0]);
      picture.height = static_cast<int>((*size)[1]);
      if (picture.width != (*size)[0] || picture.height != (*size)[1])
        table->refuse("size", "takes whole numbers");
    }
    table->read("depth", picture.depth, Range{1, 1000});
    table->read("seed", picture.seed, Range{0, 65535});
    table->read("sampling", picture.sampling, samplingNames);
    table->read("strategy", picture.strategy, strategyNames);
    table->read("samples", output.samples, Range{1, 1e6});
    table->read("seconds", output.seconds, Range{0.0, 1e7});
    table->read("error", output.error, Range{0.0, 1.0});
    table->read("least_samples", output.least, Range{2, 1e6});
    table->read("exposure", output.exposure, Range{1e-6, 1e6});
    table->read("tone", output.tone, toneNames);
    if (const auto file = table->text("output")) output.picture = *file;
  }
  picture.width = overrides.width.value_or(picture.width);
  picture.height = overrides.height.value_or(picture.height);
  output.samples = overrides.samples.value_or(output.samples);
  output.seconds = overrides.seconds.value_or(output.seconds);
  output.error = overrides.error.value_or(output.error);
}

/// Every engine reads its table, so that a scene may hold settings of several.
void readEngines(const SceneTable& root, const Overrides& overrides, Scene& scene) {
  std::vector<std::string_view> names;
  for (const EngineKind& kind : engineKinds()) {
    names.push_back(kind.name);
    scene.engines.emplace(kind.name, kind.read(root.table(kind.name)));
  }
  scene.engine = names[root.choice("engine", names).value_or(0)];
  if (overrides.engine.empty()) return;
  scene.engine = overrides.engine;
  if (!scene.engines.contains(scene.engine))
    throw std::runtime_error(
        fmt::format("there is no engine '{}'; there are {}", scene.engine, fmt::join(names, ", ")));
}

}  // namespace

Scene readScene(const std::filesystem::path& file, const Overrides& overrides) {
  const SceneTable root = examples::loadScene(file);
  Scene scene;
  scene.file = file;
  scene.name = file.stem().string();
  scene.title = root.text("title").value_or(scene.name);
  Reading reading{.folder = file.parent_path(), .strict = overrides.strict, .mostLevel = overrides.mostLevel};
  readMaterials(root, reading, scene.model);
  readShapes(root, reading, scene.model);
  readLights(root, scene.model);
  readEnvironment(root, reading, scene.model);
  scene.model.camera = readCamera(root);
  readPicture(root, overrides, scene);
  readEngines(root, overrides, scene);
  root.finish();
  chooseUnit(scene.model);
  scene.warnings = std::move(reading.warnings);
  return scene;
}

}  // namespace rays
