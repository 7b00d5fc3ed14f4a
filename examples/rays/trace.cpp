// SPDX-License-Identifier: MIT
#include "trace.hpp"

#include <algorithm>
#include <cmath>

namespace rays {
namespace {

float scaledBy(float x, int exponent) { return std::ldexp(x, exponent); }

sk::float3 scaledBy(const sk::float3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

}  // namespace

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
  std::vector<Hit> hits(rays.size());
  engine.closest(scaled, hits);
  for (std::size_t i = 0; i < hits.size(); ++i) hits[i].t = scaledBy(hits[i].t, -exponents[i]);
  return hits;
}

void toSceneLengths(const Model& model, std::span<Hit> hits) {
  const int unit = std::ilogb(model.unit);
  for (Hit& hit : hits) hit.t = scaledBy(hit.t, -unit);
}

}  // namespace rays
