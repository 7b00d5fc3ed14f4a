// SPDX-License-Identifier: MIT
#include "path_tables.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "camera.hpp"
#include "light_table.hpp"

namespace rays {
namespace {

/// As in scattering.sk, with a name for the report.
enum Feature : int {
  Mirrors = 1,
  Glass = 2,
  Metals = 4,
  Frosted = 8,
  Emitters = 16,
  DeltaLights = 32,
  Suns = 64,
  Sky = 128,
  Textures = 256,
  Smooth = 512,
  Lens = 1024,
  SkyImage = 2048
};
constexpr std::array<std::string_view, 12> featureNames = {"mirrors",
                                                           "glass",
                                                           "metals",
                                                           "frosted glass",
                                                           "lights with surfaces",
                                                           "lights without extent",
                                                           "a sun's disc",
                                                           "a sky",
                                                           "textures",
                                                           "smooth normals",
                                                           "a lens",
                                                           "the sky's image"};

/// A sky without an image is another kind of light, and not one that costs nothing.
constexpr int everything = ((1 << featureNames.size()) - 1) & ~SkyImage;

bool isBlack(const sk::float3& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

int scatteringFeature(Scattering scattering) {
  switch (scattering) {
    case Scattering::Diffuse: return 0;
    case Scattering::Mirror: return Mirrors;
    case Scattering::Glass: return Glass;
    case Scattering::Metal: return Metals;
    case Scattering::Frosted: return Frosted;
  }
  return 0;
}

/// Bits that choose between ways to reach a light, beside those of the scene.
int strategyBits(Strategy strategy) {
  switch (strategy) {
    case Strategy::Both: return 0;
    case Strategy::Lights: return 4096;
    case Strategy::Surfaces: return 8192;
  }
  return 0;
}

int featuresOf(const Model& model) {
  int features = 0;
  std::vector<bool> isUsed(model.materials.size());
  for (const Triangle& t : model.triangles) isUsed[static_cast<std::size_t>(t.material)] = true;
  for (const Sphere& s : model.spheres) isUsed[static_cast<std::size_t>(s.material)] = true;
  for (const Plane& p : model.planes) isUsed[static_cast<std::size_t>(p.material)] = true;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    if (!isUsed[i]) continue;
    const Material& m = model.materials[i];
    features |= scatteringFeature(m.scattering);
    if (m.emits()) features |= Emitters;
    if (m.texture >= 0) features |= Textures;
  }
  if (!model.points.empty()) features |= DeltaLights;
  for (const Sun& sun : model.suns) features |= sun.angle > 0 ? Suns : DeltaLights;
  if (!isBlack(model.environment.colour))
    features |= Sky | (model.environment.image.pixels.empty() ? 0 : SkyImage);
  const bool isSmooth =
      std::ranges::any_of(model.corners, [](const Corners& c) { return !isBlack(c.normals[0]); });
  if (isSmooth) features |= Smooth;
  if (model.camera.lens > 0) features |= Lens;
  return features;
}

std::vector<sk::float4> materialsOf(const Model& model, const std::vector<double>& shares) {
  std::vector<sk::float4> elements;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const Material& m = model.materials[i];
    elements.push_back(
        {m.colour.x, m.colour.y, m.colour.z, packedInt(static_cast<std::int64_t>(m.scattering))});
    elements.push_back({m.emission.x, m.emission.y, m.emission.z, packedInt(m.texture)});
    elements.push_back({m.ior, m.roughness, static_cast<float>(shares[i]), m.glowsBehind ? 1.0f : 0.0f});
  }
  return elements;
}

std::vector<sk::float4> cornersOf(const Model& model) {
  std::vector<sk::float4> elements;
  for (const Corners& c : model.corners) {
    const std::array<sk::float3, 3>& n = c.normals;
    const std::array<sk::float2, 3>& t = c.texture;
    elements.push_back({n[0].x, n[0].y, n[0].z, t[0].x});
    elements.push_back({n[1].x, n[1].y, n[1].z, t[0].y});
    elements.push_back({n[2].x, n[2].y, n[2].z, t[1].x});
    elements.push_back({t[1].y, t[2].x, t[2].y, isBlack(n[0]) ? 0.0f : 1.0f});
  }
  return elements;
}

kernels::View viewFor(const Camera& camera, const Picture& picture) {
  const View view = viewOf(camera, std::max(picture.width, 1), std::max(picture.height, 1));
  const Vector x = normalized(view.across), y = normalized(view.down);
  return {toFloat3(view.origin),
          toFloat3(view.corner),
          toFloat3(view.across),
          toFloat3(view.down),
          toFloat3(camera.lens * x),
          toFloat3(camera.lens * y),
          static_cast<float>(camera.focus > 0 ? camera.focus : 1.0),
          {picture.width, picture.height}};
}

}  // namespace

PathTables::PathTables(sk::Device& device, const Model& model, const Picture& picture)
    : features(featuresOf(model) | strategyBits(picture.strategy)),
      view(viewFor(model.camera, picture)),
      sunCount(static_cast<int>(model.suns.size())),
      skyColour(model.environment.colour),
      skySize{model.environment.image.width, model.environment.image.height} {
  if (picture.everything) features |= everything;
  LightTable table = lightTable(model);
  lightCount = table.count;
  skyChoice = static_cast<float>(table.skyChoice);
  materials = streamOf(device, materialsOf(model, table.shares));
  corners = streamOf(device, cornersOf(model));
  lights = streamOf(device, std::move(table.lights));
  sky = streamOf(device, std::move(table.sky));
  std::vector<sk::float4> ofTextures;
  std::vector<sk::int4> places;
  for (const Raster& raster : model.textures) {
    places.push_back({static_cast<int>(ofTextures.size()), raster.width, raster.height, 0});
    for (const sk::float3& p : raster.pixels) ofTextures.push_back({p.x, p.y, p.z, 0});
  }
  texels = streamOf(device, std::move(ofTextures));
  textures = streamOf(device, std::move(places));
}

std::string PathTables::account() const {
  std::vector<std::string_view> with, without;
  for (std::size_t i = 0; i < featureNames.size(); ++i)
    (features >> i & 1 ? with : without).push_back(featureNames[i]);
  return fmt::format("the scene has {}; its kernel is compiled without {}",
                     with.empty() ? "nothing but diffuse surfaces" : fmt::format("{}", fmt::join(with, ", ")),
                     without.empty() ? "nothing" : fmt::format("{}", fmt::join(without, ", ")));
}

kernels::Scene PathTables::scene(const DeviceShapes& shapes) const {
  kernels::Scene scene = shapes.scene();
  scene.materials = {.rows = materials, .corners = corners, .texels = texels, .textures = textures};
  scene.lights = {.rows = lights,
                  .count = lightCount,
                  .suns = sunCount,
                  .sky = {.colour = skyColour, .image = sky, .size = skySize, .choice = skyChoice}};
  scene.features = features;
  return scene;
}

kernels::Scene PathsRenderer::scene() const {
  kernels::Scene scene = tables_.scene(shapes_);
  if (exposure_.isSparse()) scene.features = tables_.features | listed;
  return scene;
}

kernels::Picture PathsRenderer::sample(std::int64_t index) const {
  return {.view = tables_.view,
          .pixels = exposure_.isSparse() ? exposure_.pixels() : noPixels_,
          .depth = picture_.depth,
          .sampling = static_cast<unsigned>(picture_.sampling),
          .sample = static_cast<std::uint32_t>(index),
          .seed = picture_.seed};
}

void PathsRenderer::look(const Camera& camera) {
  tables_.view = viewFor(camera, picture_);
  exposure_.clear();
}

}  // namespace rays
