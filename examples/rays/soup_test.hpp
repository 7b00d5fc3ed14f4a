// SPDX-License-Identifier: MIT
//
// Scenes and rays at random, for tests of engines.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "model.hpp"

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

}  // namespace rays
