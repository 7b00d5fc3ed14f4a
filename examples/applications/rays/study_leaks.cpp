// SPDX-License-Identifier: MIT
//
// Rays from the inside of closed meshes at their edges and vertices: each that meets nothing has slipped through.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "engine.hpp"
#include "reference.hpp"
#include "shapes.hpp"
#include "study.hpp"
#include "support/table.hpp"

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

struct Tested {
  std::string_view name;
  HowToIntersect how;
  sk::Precision precision;
};

constexpr std::array allTested = {Tested{"watertight", HowToIntersect::Watertight, sk::Precision::Single},
                                  Tested{"watertight", HowToIntersect::Watertight, sk::Precision::Extended},
                                  Tested{"watertight", HowToIntersect::Watertight, sk::Precision::Double},
                                  Tested{"moller", HowToIntersect::Moller, sk::Precision::Single}};

std::string_view precisionOf(sk::Precision precision) {
  return precision == sk::Precision::Single   ? "single"
         : precision == sk::Precision::Double ? "double"
                                              : "extended";
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

Findings studyNeedles(sk::Device& device, bool isSmall) {
  const std::size_t triangles = isSmall ? 100 : 500, rays = isSmall ? 200 : 5000;
  examples::Table table(
      {"test", "computed in", "length / height", "error of t, 2^-24", "bound, 2^-24", "error / bound"});
  examples::Verification bound("errors of hits of needles", 0x1p-20,
                               "16 roundings of floats, and what the shape of a triangle adds");
  for (const Tested& tested : allTested) {
    for (int power = 1; power <= 7; power += tested.precision == sk::Precision::Single ? 1 : 3) {
      const Model model = needles(std::pow(10.0, power), triangles, static_cast<unsigned>(power));
      const std::unique_ptr<Engine> engine =
          makeBvhEngine(device, model, {.intersection = tested.how, .precision = tested.precision});
      const std::vector<Ray> all = raysToTriangles(model, rays, 61);
      const std::vector<Hit> hits = traceRays(*engine, model, all);
      const TriangleTest test = engine->triangleTest();
      double largest = 0.0, most = 0.0, part = 0.0;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const double error = errorOf(model, all[i], hits[i], test);
        bound.note(static_cast<std::int64_t>(i), error);
        part = std::max(part, error);
        if (hits[i].id < 0) continue;
        const Triangle& triangle = model.triangles[static_cast<std::size_t>(hits[i].id)];
        const Meeting meeting = meet(triangle, all[i]);
        largest = std::max(largest, std::abs(hits[i].t - meeting.t) * meeting.across);
        most = std::max(most, needleError(triangle, test, 1.0));
      }
      table.add({std::string(tested.name), std::string(precisionOf(tested.precision)),
                 fmt::format("1e{}", power), fmt::format("{:.3g}", largest * 0x1p24),
                 fmt::format("{:.3g}", 16.0 + most * 0x1p24), fmt::format("{:.2f}", part * 0x1p20)});
    }
  }
  return {table.markdown(), {bound}};
}

}  // namespace rays
