// SPDX-License-Identifier: MIT
#include "engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "exposure.hpp"
#include "ray_engine.hpp"
#include "streaming_engine.hpp"

namespace rays {
namespace {

float scaledBy(float x, int exponent) { return std::ldexp(x, exponent); }

sk::float3 scaledBy(const sk::float3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

}  // namespace

std::span<const EngineKind> engineKinds() {
  static constexpr std::array kinds = {
      EngineKind{"bvh", "a hierarchy of boxes, all in one kernel", readBvhEngine},
      EngineKind{"streaming", "a uniform grid in streams (Purcell and others, 2002)", readStreamingEngine},
      EngineKind{"ray_engine", "buckets of rays that the host sends (Carr and others, 2002)", readRayEngine},
  };
  return kinds;
}

void refuseDivided(const Picture& picture, std::string_view what) {
  if (picture.grid == nullptr) return;
  throw std::runtime_error(
      fmt::format("{} keeps lists of all rays on one device, but the pixels are divided over ranks; take "
                  "--engine bvh, or "
                  "start it without mpirun",
                  what));
}

std::vector<sk::float3> Renderer::image() { return exposure().image(); }

std::vector<sk::float3> Renderer::variance() { return exposure().variance(); }

std::vector<Hit> hitsOf(Engine& engine, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  engine.closest(rays, hits);
  return hits;
}

std::vector<std::uint8_t> shadowsOf(Engine& engine, std::span<const Ray> rays) {
  std::vector<std::uint8_t> blocked(rays.size());
  engine.occluded(rays, blocked);
  return blocked;
}

std::vector<Hit> traceRays(Engine& engine, const Model& model, std::span<const Ray> rays) {
  // Powers of two change no digit: origins go to the model's unit, and directions to a greatest component from 1 to 2.
  const int unit = std::ilogb(model.unit);
  std::vector<Ray> scaled;
  std::vector<int> exponents;
  for (const Ray& ray : rays) {
    const float greatest =
        std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
    const int own = std::ilogb(greatest);
    exponents.push_back(unit + own);
    scaled.push_back({scaledBy(ray.origin, unit), scaledBy(ray.least, unit + own),
                      scaledBy(ray.direction, -own), scaledBy(ray.most, unit + own)});
  }
  std::vector<Hit> hits = hitsOf(engine, scaled);
  for (std::size_t i = 0; i < hits.size(); ++i) hits[i].t = scaledBy(hits[i].t, -exponents[i]);
  return hits;
}

void toSceneLengths(const Model& model, std::span<Hit> hits) {
  const int unit = std::ilogb(model.unit);
  for (Hit& hit : hits) hit.t = scaledBy(hit.t, -unit);
}

}  // namespace rays
