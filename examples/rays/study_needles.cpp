// SPDX-License-Identifier: MIT
//
// Rays at triangles that are 10 to 10^7 times as long as high: how far hits are from their planes, beside the bound that docs/rays.md derives.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "reference.hpp"
#include "study.hpp"
#include "support/table.hpp"
#include "trace.hpp"

namespace rays {
namespace {

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
