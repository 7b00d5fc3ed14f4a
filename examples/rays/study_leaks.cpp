// SPDX-License-Identifier: MIT
//
// Rays from the inside of closed meshes at their edges and vertices: each that meets nothing has slipped through.
#include "study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "reference.hpp"
#include "shapes.hpp"
#include "support/table.hpp"
#include "trace.hpp"

namespace rays {
namespace {

/// Rays that are there at once.
constexpr std::size_t raysAtOnce = 1'000'000;

std::int64_t countLeaks(Engine& engine, const Model& model, Vector moved, std::size_t count) {
  std::int64_t leaks = 0;
  for (std::size_t first = 0; first < count; first += raysAtOnce) {
    const auto seed = static_cast<unsigned>(11 + first / raysAtOnce);
    const std::vector<Hit> hits =
        traceRays(engine, model, raysToEdges(model, moved, std::min(raysAtOnce, count - first), seed));
    leaks += std::ranges::count_if(hits, [](const Hit& hit) { return hit.id < 0; });
  }
  return leaks;
}

/// In units of 2^-24 of the lengths that a distance is computed from.
double largestError(Engine& engine, const Model& model, Vector moved) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    const Vector from = moved + 2.0 * normalized(Vector{normal(random), normal(random), normal(random)});
    const Vector to = moved + 0.3 * Vector{normal(random), normal(random), normal(random)};
    rays.push_back({.origin = toFloat3(from), .direction = toFloat3(normalized(to - from))});
  }
  const std::vector<Hit> hits = traceRays(engine, model, rays);
  double largest = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) largest = std::max(largest, errorOf(model, rays[i], hits[i]));
  return largest * 0x1p24;
}

}  // namespace

Findings studyLeaks(sk::Device& device, bool isSmall) {
  // 10^8 of the watertight test in all.
  const std::size_t many = isSmall ? 20'000 : 17'000'000, some = isSmall ? 20'000 : 1'000'000;
  examples::Table table(
      {"mesh", "moved by", "test", "million rays", "leaks of a million", "largest error of t, 2^-24"});
  examples::Verification sound("leaks of the watertight test", 0.0,
                               "the sign of every edge function is exact");
  const std::array<std::pair<std::string_view, Mesh>, 2> meshes = {
      std::pair{"sphere, 5,120 triangles", icosphere(4, false)}, std::pair{"box, 12 triangles", box()}};
  for (const auto& [name, mesh] : meshes) {
    for (const double moved : {0.0, 1024.0, 65536.0}) {
      const Vector by = {moved, -moved, moved};
      const Model model = modelOf(mesh, by);
      for (const HowToIntersect how : {HowToIntersect::Watertight, HowToIntersect::Moller}) {
        const bool isWatertight = how == HowToIntersect::Watertight;
        const std::unique_ptr<Engine> engine = makeBvhEngine(device, model, {.intersection = how});
        const std::size_t count = isWatertight ? many : some;
        const std::int64_t leaks = countLeaks(*engine, model, by, count);
        if (isWatertight) sound.note(static_cast<std::int64_t>(moved), double(leaks));
        table.add({std::string(name), fmt::format("{:.0f}", moved), isWatertight ? "watertight" : "moller",
                   fmt::format("{:g}", double(count) / 1e6),
                   fmt::format("{:.1f}", 1e6 * double(leaks) / double(count)),
                   fmt::format("{:.2f}", largestError(*engine, model, by))});
      }
    }
  }
  return {table.markdown(), {sound}};
}

}  // namespace rays
