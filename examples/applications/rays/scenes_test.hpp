// SPDX-License-Identifier: MIT
//
// Scenes and rays at random, for tests of engines; scenes that a test writes as text, their pictures, and what is wrong with hits and meshes.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "engine.hpp"
#include "mesh.hpp"
#include "model.hpp"
#include "reference.hpp"
#include "scene.hpp"
#include "support/testing.hpp"

namespace rays {

struct SoupSize {
  int triangles = 300;
  int spheres = 20;
  int planes = 1;
};

/// Random shapes within the cube from -1 to 1, whose ids are a permutation of the triangles' order.
inline Model soup(const SoupSize& size) {
  std::mt19937 random(11);
  const auto within = [&](float low, float high) { return low + (high - low) * float(random()) * 0x1p-32f; };
  const auto point = [&](float reach) {
    return sk::float3{within(-reach, reach), within(-reach, reach), within(-reach, reach)};
  };
  Model model;
  model.triangleCount = size.triangles;
  for (int i = 0; i < size.triangles; ++i) {
    const sk::float3 a = point(0.8f), b = point(0.2f), c = point(0.2f);
    model.triangles.push_back(
        {a, {a.x + b.x, a.y + b.y, a.z + b.z}, {a.x + c.x, a.y + c.y, a.z + c.z}, size.triangles - 1 - i, 0});
  }
  for (int i = 0; i < size.spheres; ++i) model.spheres.push_back({point(0.8f), within(0.01f, 0.2f), 0});
  for (int i = 0; i < size.planes; ++i) model.planes.push_back({{0, 1, 0}, -0.7f - float(i), 0});
  model.materials.push_back({.name = "grey"});
  return model;
}

/// Random rays from inside and outside of the cube; some are short, some run along an axis.
inline std::vector<Ray> raysAtRandom(int count) {
  std::mt19937 random(17);
  const auto within = [&](float low, float high) { return low + (high - low) * float(random()) * 0x1p-32f; };
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const float reach = i % 3 == 0 ? 0.9f : 3.0f;
    Ray r;
    r.origin = {within(-reach, reach), within(-reach, reach), within(-reach, reach)};
    r.direction = {within(-0.8f, 0.8f) - r.origin.x, within(-0.8f, 0.8f) - r.origin.y,
                   within(-0.8f, 0.8f) - r.origin.z};
    float* d[] = {&r.direction.x, &r.direction.y, &r.direction.z};
    if (i % 5 == 0) *d[i % 3] = i % 2 == 0 ? 0.0f : -0.0f;
    const float greatest =
        std::max({std::abs(r.direction.x), std::abs(r.direction.y), std::abs(r.direction.z)});
    for (float* component : d) *component /= greatest;
    if (i % 7 == 0) r.most = within(0.0f, 2.0f);
    if (i % 11 == 0) r.least = within(0.0f, 1.0f);
    rays.push_back(r);
  }
  return rays;
}

/// A scene that a test writes as text, to a file of its own.
inline Scene sceneFrom(const std::string& text, const Overrides& overrides = {}) {
  return readScene(examples::WrittenFile(text, fmt::format("written_{}.toml", ::getpid())).path(), overrides);
}

/// With the settings that a scene's table of that name may have.
inline std::unique_ptr<Engine> engineOf(sk::Device& device, const Model& model,
                                        const std::string& settings = "", const std::string& name = "bvh") {
  return sceneFrom(fmt::format("[{}]\n{}", name, settings)).engines.at(name)(device, model);
}

/// Renders a picture with `samples` samples in each pixel.
inline std::vector<sk::float3> imageOf(Engine& engine, const Picture& picture, int samples) {
  const std::unique_ptr<Renderer> renderer = engine.renderer(picture);
  for (int i = 0; i < samples; ++i) renderer->pass(i);
  return renderer->image();
}

/// By an engine of the scene that the text has: the red, green and blue of all pixels, in row-major order.
inline std::vector<float> pictureBy(sk::Device& device, const std::string& text, const char* engine,
                                    int samples) {
  const Scene scene = sceneFrom(text);
  std::vector<float> components;
  for (const sk::float3& p : imageOf(*scene.engines.at(engine)(device, scene.model), scene.picture, samples))
    components.insert(components.end(), {p.x, p.y, p.z});
  return components;
}

inline std::size_t misses(const std::vector<Hit>& hits) {
  return static_cast<std::size_t>(std::ranges::count_if(hits, [](const Hit& hit) { return hit.id < 0; }));
}

/// The largest error of the hits, compared with a test of all triangles.
inline double largestError(const Model& model, const std::vector<Ray>& rays, const std::vector<Hit>& hits) {
  double largest = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) largest = std::max(largest, errorOf(model, rays[i], hits[i]));
  return largest;
}

/// Returns true if every directed edge occurs as often as its reverse.
inline bool isClosed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Face& face : mesh.faces)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = face.points[i], b = face.points[(i + 1) % 3];
      ++balance[{a, b}];
      --balance[{b, a}];
    }
  return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

}  // namespace rays
