// SPDX-License-Identifier: MIT
#include "layers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera.hpp"
#include "engine.hpp"
#include "raster_file.hpp"

namespace rays {
namespace {

using examples::vecOf;

/// What a hit shows: the unit normal as the surface has it, material and place in the texture.
struct Seen {
  Vector normal{};
  std::int32_t material = 0;
  sk::float2 texture{};
};

Vector mixed(const std::array<sk::float3, 3>& v, const Hit& hit) {
  return double(1 - hit.u - hit.v) * vecOf<double>(v[0]) + double(hit.u) * vecOf<double>(v[1]) +
         double(hit.v) * vecOf<double>(v[2]);
}

Seen onTriangle(const Model& model, const Hit& hit) {
  const auto found = std::ranges::lower_bound(model.triangles, hit.id, {}, &Triangle::id);
  const Triangle& t = *found;
  const auto a = vecOf<double>(t.a);
  Seen seen{normalized(cross(vecOf<double>(t.b) - a, vecOf<double>(t.c) - a)), t.material, {hit.u, hit.v}};
  if (model.corners.empty()) return seen;
  const Corners& corners = model.corners[static_cast<std::size_t>(found - model.triangles.begin())];
  const Vector shading = normalized(mixed(corners.normals, hit));
  if (length(shading) > 0) seen.normal = dot(shading, seen.normal) < 0 ? -1.0 * shading : shading;
  const float w = 1 - hit.u - hit.v;
  const std::array<sk::float2, 3>& at = corners.texture;
  seen.texture = {w * at[0].x + hit.u * at[1].x + hit.v * at[2].x,
                  w * at[0].y + hit.u * at[1].y + hit.v * at[2].y};
  return seen;
}

Seen seenAt(const Model& model, const Ray& ray, const Hit& hit) {
  if (hit.id >= model.planeId(0)) {
    const Plane& plane = model.planes[static_cast<std::size_t>(hit.id - model.planeId(0))];
    return {vecOf<double>(plane.normal), plane.material, {}};
  }
  if (hit.id < model.sphereId(0)) return onTriangle(model, hit);
  const Sphere& sphere = model.spheres[static_cast<std::size_t>(hit.id - model.sphereId(0))];
  const Vector point = vecOf<double>(ray.origin) + double(hit.t) * vecOf<double>(ray.direction);
  return {normalized(point - vecOf<double>(sphere.centre)), sphere.material, {hit.u, hit.v}};
}

/// As kernels interpolate textures, which repeat.
sk::float3 textureAt(const Raster& raster, const sk::float2& at) {
  const auto place = [](float x, int size) { return (x - std::floor(x)) * static_cast<float>(size) - 0.5f; };
  const float x = place(at.x, raster.width), y = place(at.y, raster.height);
  const float tx = x - std::floor(x), ty = y - std::floor(y);
  const auto texel = [&](int dx, int dy) {
    const int i = (static_cast<int>(std::floor(x)) + dx + raster.width) % raster.width;
    const int j = (static_cast<int>(std::floor(y)) + dy + raster.height) % raster.height;
    return vecOf<float>(raster.pixels[std::size_t(j) * std::size_t(raster.width) + std::size_t(i)]);
  };
  const auto top = (1 - tx) * texel(0, 0) + tx * texel(1, 0),
             bottom = (1 - tx) * texel(0, 1) + tx * texel(1, 1);
  const auto c = (1 - ty) * top + ty * bottom;
  return {c.x, c.y, c.z};
}

sk::float3 albedoOf(const Model& model, const Seen& seen) {
  const Material& m = model.materials[static_cast<std::size_t>(seen.material)];
  if (m.texture < 0) return m.colour;
  const sk::float3 t = textureAt(model.textures[static_cast<std::size_t>(m.texture)], seen.texture);
  return {m.colour.x * t.x, m.colour.y * t.y, m.colour.z * t.z};
}

sk::float3 grey(float x) { return {x, x, x}; }

}  // namespace

std::vector<Layer> layersOf(Engine& engine, const Model& model, const Picture& picture) {
  const std::vector<Ray> rays = primaryRays(model.camera, picture.width, picture.height);
  std::vector<Hit> hits = hitsOf(engine, rays);
  std::vector<Layer> layers = {{.name = "depth", .isSingle = true},
                               {.name = "normal"},
                               {.name = "albedo"},
                               {.name = "id", .isSingle = true}};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool isHit = hits[i].id >= 0;
    const Seen seen = isHit ? seenAt(model, rays[i], hits[i]) : Seen{};
    const bool isBehind = dot(seen.normal, vecOf<double>(rays[i].direction)) > 0;
    layers[1].pixels.push_back(toFloat3(isBehind ? -1.0 * seen.normal : seen.normal));
    layers[2].pixels.push_back(isHit ? albedoOf(model, seen) : grey(0));
    layers[3].pixels.push_back(grey(static_cast<float>(hits[i].id)));
    layers[3].whole.push_back(hits[i].id);
  }
  toSceneLengths(model, hits);
  for (const Hit& hit : hits) layers[0].pixels.push_back(grey(hit.t));
  return layers;
}

bool seesBacksAlone(Engine& engine, const Model& model) {
  const std::vector<Ray> rays = primaryRays(model.camera, 8, 8);
  const std::vector<Hit> hits = hitsOf(engine, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].id < 0) return false;
    const Seen seen = seenAt(model, rays[i], hits[i]);
    const Scattering scattering = model.materials[static_cast<std::size_t>(seen.material)].scattering;
    const bool isClear = scattering == Scattering::Glass || scattering == Scattering::Frosted;
    if (isClear || dot(seen.normal, vecOf<double>(rays[i].direction)) <= 0) return false;
  }
  return true;
}

std::vector<Layer> layersOf(Exposure& exposure) {
  std::vector<Layer> layers;
  if (exposure.passes() >= 2) layers.push_back({.name = "variance", .pixels = exposure.variance()});
  Layer samples{.name = "samples", .isSingle = true, .whole = exposure.counts()};
  for (const int count : samples.whole) samples.pixels.push_back(grey(static_cast<float>(count)));
  layers.push_back(std::move(samples));
  return layers;
}

void saveLayers(const std::string& prefix, const std::vector<Layer>& layers, const Picture& picture) {
  for (const Layer& layer : layers)
    savePfm(prefix + "_" + layer.name + ".pfm", picture.width, picture.height, layer.pixels);
}

}  // namespace rays
