// SPDX-License-Identifier: MIT
#include "vertex_storage.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace rays {
namespace {

using examples::vecOf;

/// As in shape_test.sk.
constexpr float halvesOfUnit = 0x1p+14f;
constexpr int digits = 2048;
constexpr float leastNormal = 0x1p-14f;  // of halves

sk::half4 rowOf(const sk::float3& v, int digit) {
  return {sk::half(halvesOfUnit * v.x), sk::half(halvesOfUnit * v.y), sk::half(halvesOfUnit * v.z),
          sk::half(static_cast<float>(digit))};
}

float rounded(float x) {
  const float scaled = halvesOfUnit * x;
  // 65520 is what rounds to infinity. The negation refuses NaN as well.
  if (!(std::abs(scaled) < 65520.0f))
    throw std::runtime_error(
        fmt::format("storage = \"half\": a length of {} is too large for halves; bring the model's extent "
                    "near 1, or take storage = \"single\"",
                    x));
  return std::abs(scaled) < leastNormal ? 0.0f : float{sk::half(scaled)} / halvesOfUnit;
}

/// Returns the distance by which the point moves.
double moveToHalves(sk::float3& p) {
  const sk::float3 to = {rounded(p.x), rounded(p.y), rounded(p.z)};
  const double distance = length(vecOf<double>(to) - vecOf<double>(p));
  p = to;
  return distance;
}

bool hasArea(const Triangle& t) {
  const auto a = vecOf<double>(t.a), b = vecOf<double>(t.b), c = vecOf<double>(t.c);
  return length(cross(b - a, c - a)) > 0;
}

}  // namespace

Rounding roundToHalves(Model& model) {
  Rounding rounding;
  for (Triangle& t : model.triangles) {
    const bool had = hasArea(t);
    rounding.farthest =
        std::max({rounding.farthest, moveToHalves(t.a), moveToHalves(t.b), moveToHalves(t.c)});
    if (had && !hasArea(t)) ++rounding.collapsed;
  }
  for (Sphere& s : model.spheres) {
    const float radius = std::max(rounded(s.radius), leastNormal / halvesOfUnit);
    rounding.farthest =
        std::max(rounding.farthest, moveToHalves(s.centre) + std::abs(double(radius) - s.radius));
    s.radius = radius;
  }
  rounding.farthest /= model.unit;
  return rounding;
}

HalfLayout halfLayout(std::span<const std::uint32_t> order, const Model& model) {
  if (model.materials.size() > std::size_t{digits} * digits)
    throw std::runtime_error(
        "storage = \"half\" has room for 4194304 materials; take fewer, or storage = \"single\"");
  HalfLayout layout;
  layout.rows.reserve(3 * order.size());
  layout.numbers.reserve(order.size());
  const auto add = [&](const sk::float3& a, const sk::float3& b, const sk::float3& c, int material) {
    layout.rows.insert(layout.rows.end(),
                       {rowOf(a, material / digits), rowOf(b, material % digits), rowOf(c, 0)});
  };
  for (const std::uint32_t i : order) {
    if (i < model.triangles.size()) {
      const Triangle& t = model.triangles[i];
      add(t.a, t.b, t.c, t.material);
      layout.numbers.push_back({t.id, static_cast<std::int32_t>(i)});
    } else {
      const std::size_t s = i - model.triangles.size();
      const Sphere& sphere = model.spheres[s];
      add(sphere.centre, {sphere.radius, 0, 0}, {0, 0, 0}, sphere.material);
      layout.numbers.push_back({model.sphereId(s), -1});
    }
  }
  return layout;
}

}  // namespace rays
