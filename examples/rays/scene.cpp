// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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
  m.name = table.text("name").value_or("");
  if (m.name.empty()) refuse(table, "name", "is missing; things name their material by it");
  if (reading.materials.contains(m.name))
    refuse(table, "name", fmt::format("'{}' is taken by another material", m.name));
  m.scattering = static_cast<Scattering>(table.choice("type", scatteringNames).value_or(0));
  const bool isClear = m.scattering == Scattering::Glass || m.scattering == Scattering::Frosted;
  const bool isRough = m.scattering == Scattering::Metal || m.scattering == Scattering::Frosted;
  const sk::float3 grey = {0.8f, 0.8f, 0.8f}, white = {1, 1, 1};
  m.colour = colourOf(table, "colour", isClear ? white : grey);
  if (std::max({m.colour.x, m.colour.y, m.colour.z}) > 1)
    refuse(table, "colour", "has components from 0 to 1; what is brighter would make light");
  m.emission = colourOf(table, "emission", {0, 0, 0});
  m.glowsBehind = table.flag("both_sides").value_or(false);
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
          {toFloat3(vectorOf(table, "position", {0, 0, 0})), colourOf(table, "intensity", {1, 1, 1})});
      continue;
    }
    const Vector towards = vectorOf(table, "towards", {0, 1, 0});
    if (!(length(towards) > 0)) refuse(table, "towards", "must not be zero");
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
  camera.from = vectorOf(*table, "from", camera.from);
  camera.to = vectorOf(*table, "to", camera.to);
  camera.up = vectorOf(*table, "up", camera.up);
  camera.fieldOfView = table->number("field_of_view", Range{0.01, 179.0}).value_or(camera.fieldOfView);
  camera.lens = table->number("lens", Range{0.0, 1e30}).value_or(0.0);
  camera.focus = table->number("focus", positiveLength).value_or(length(camera.to - camera.from));
  if (camera.from == camera.to) refuse(*table, "to", "is the point 'from', so the camera looks nowhere");
  if (!(length(cross(normalized(camera.to - camera.from), normalized(camera.up))) > 1e-9))
    refuse(*table, "up", "is zero, or the direction in which the camera looks");
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
        refuse(*table, "size", "takes whole numbers");
    }
    picture.depth = static_cast<int>(table->integer("depth", Range{1, 1000}).value_or(picture.depth));
    picture.seed = static_cast<std::uint32_t>(table->integer("seed", Range{0, 65535}).value_or(picture.seed));
    picture.sampling = static_cast<Sampling>(table->choice("sampling", samplingNames).value_or(1));
    picture.strategy = static_cast<Strategy>(table->choice("strategy", strategyNames).value_or(0));
    output.samples = table->integer("samples", Range{1, 1e6}).value_or(output.samples);
    output.seconds = table->number("seconds", Range{0.0, 1e7}).value_or(output.seconds);
    output.error = table->number("error", Range{0.0, 1.0}).value_or(output.error);
    output.least = static_cast<int>(table->integer("least_samples", Range{2, 1e6}).value_or(output.least));
    output.exposure = table->number("exposure", Range{1e-6, 1e6}).value_or(output.exposure);
    output.tone = static_cast<ToneMap>(table->choice("tone", toneNames).value_or(0));
    if (const auto file = table->text("output")) output.picture = *file;
  }
  if (overrides.width) picture.width = *overrides.width;
  if (overrides.height) picture.height = *overrides.height;
  if (overrides.samples) output.samples = *overrides.samples;
  if (overrides.seconds) output.seconds = *overrides.seconds;
  if (overrides.error) output.error = *overrides.error;
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
