// SPDX-License-Identifier: MIT
#include "painter.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pool.sk.hpp"

namespace waves {

namespace {

constexpr int finer = 2;  // pixels for each of the picture, in each direction
constexpr std::int64_t photonsAcross = 4;  // of a texel of the floor

sk::float3 vector(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

Pool poolOf(const Scene& scene) {
  const Model& m = scene.model;
  const View& v = scene.view;
  Pool pool{};
  const double width = static_cast<double>(m.width) * m.spacing;
  pool.size = {1.0f, static_cast<float>(static_cast<double>(m.height) / static_cast<double>(m.width))};
  pool.depth = static_cast<float>(v.depth);
  pool.rim = 0.025f;
  pool.spacing = static_cast<float>(1.0 / static_cast<double>(m.width));
  pool.exaggeration = static_cast<float>(v.exaggeration / width);
  pool.tile = static_cast<float>(1.0 / v.tiles);
  const double x = -0.40, y = 0.62, z = 0.80, norm = std::sqrt(x * x + y * y + z * z);
  pool.sun = vector(x / norm, y / norm, z / norm);
  return pool;
}

Camera cameraOf(const Scene& scene, const Pool& pool) {
  const View& v = scene.view;
  const double away = 2.1 * v.distance * std::max(1.0f, pool.size.y), spread = 0.36;
  const double ax = std::sin(v.turn) * std::cos(v.tilt), ay = std::cos(v.turn) * std::cos(v.tilt),
               az = -std::sin(v.tilt);
  Camera c{};
  c.eye = vector(0.5 - away * ax, 0.5 * static_cast<double>(pool.size.y) - away * ay, -away * az);
  c.ahead = vector(ax, ay, az);
  c.right = vector(spread * std::cos(v.turn), -spread * std::sin(v.turn), 0.0);
  const double up = spread * v.height / v.width;
  c.up = vector(up * std::sin(v.turn) * std::sin(v.tilt), up * std::cos(v.turn) * std::sin(v.tilt),
                up * std::cos(v.tilt));
  return c;
}

/// Texels of the floor, rows first: about as many as cells, and enough for a picture.
sk::Shape floorShape(const Model& m) {
  const double finest =
      static_cast<double>(std::clamp<std::int64_t>(2 * std::max(m.width, m.height), 64, 768)) /
      static_cast<double>(std::max(m.width, m.height));
  const auto extent = [&](std::int64_t n) {
    return std::max<std::int64_t>(std::llround(static_cast<double>(n) * finest), 2);
  };
  return {extent(m.height), extent(m.width)};
}

}  // namespace

Painter::Painter(sk::Device& device, const Scene& scene)
    : device_(device), scene_(scene), light_(device.stream<float>(floorShape(scene.model))) {
  const sk::Shape shape = {light_.shape()[0] * photonsAcross, light_.shape()[1] * photonsAcross};
  const Pool pool = poolOf(scene);
  std::vector<sk::float3> photons;
  photons.reserve(static_cast<std::size_t>(shape.size()));
  for (std::int64_t y = 0; y < shape[0]; ++y)
    for (std::int64_t x = 0; x < shape[1]; ++x)
      photons.push_back(vector(
          (static_cast<double>(x) + 0.5) / static_cast<double>(shape[1]),
          (static_cast<double>(y) + 0.5) / static_cast<double>(shape[0]) * static_cast<double>(pool.size.y),
          1.0));
  photons_ = device.stream<sk::float3>(shape);
  photons_.write(photons);
}

examples::Image Painter::paint(const Surface& surface) {
  const Pool pool = poolOf(scene_);
  const View& v = scene_.view;
  const sk::Stream<float>& heights = gathered_.of(surface.heightStream(), device_);
  if (!heights) return {};
  light_.fill(0.0f);
  shine(pool, 1.0f / static_cast<float>(photonsAcross * photonsAcross), photons_, heights, light_);
  auto colour = device_.stream<sk::float3>({std::int64_t{v.height} * finer, std::int64_t{v.width} * finer});
  look(pool, cameraOf(scene_, pool), heights, light_, colour);
  return examples::reduced(examples::imageOf(v.width * finer, v.height * finer, colour.read()), finer);
}

}  // namespace waves
