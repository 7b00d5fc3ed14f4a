// SPDX-License-Identifier: MIT
//
// What the sizes of buckets and calls are worth to the ray engine, and whether the host waits, beside engines that leave everything to the device.
#include "study.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "camera.hpp"
#include "pass_meter.hpp"
#include "ray_engine.hpp"
#include "reference.hpp"
#include "streaming_engine.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

struct EngineCase {
  const char* name;
  RayEngineSettings settings;
};

/// Each dial on its own, about the defaults.
std::vector<EngineCase> waysOf() {
  std::vector<EngineCase> ways = {{"as it comes", {}}};
  for (const int bucket : {64, 1024, 4096}) ways.push_back({"bucket", {.bucket = bucket}});
  for (const int shapes : {1, 4, 16}) ways.push_back({"shapes a call", {.shapesPerCall = shapes}});
  for (const int flights : {0, 1, 16}) ways.push_back({"in flight", {.inFlight = flights}});
  for (const int cache : {1, 8, 512}) ways.push_back({"cache", {.cache = cache}});
  // An octree of one leaf finds shapes by their own boxes alone.
  ways.push_back({"no octree", {.leaf = 1 << 30}});
  return ways;
}

/// The best of some runs, rays to the device and hits back included.
double bestOfEngine(const sk::Device& device, Engine& engine, const std::vector<Ray>& rays, int runs) {
  std::vector<Hit> hits(rays.size());
  engine.closest(rays, hits);  // compiles
  double best = HUGE_VAL;
  for (int i = 0; i < runs; ++i)
    best = std::min(best, milliseconds(device, [&] { engine.closest(rays, hits); }));
  return best;
}

}  // namespace

Findings studyRayEngine(sk::Device& device, bool isSmall) {
  const int side = isSmall ? 32 : 128, runs = isSmall ? 1 : 3;
  Model model = speedModel(true);
  const std::vector<Ray> primary = primaryRays(model.camera, side, side);
  const std::unique_ptr<Engine> hierarchy = makeBvhEngine(device, model, {});
  const std::vector<Hit> hits = hitsOf(*hierarchy, primary);
  const std::vector<Ray> diffuse = diffuseRays(model, primary, hits, primary.size());
  const auto rate = [](const std::vector<Ray>& rays, double time) {
    return fmt::format("{:.3f}", double(rays.size()) / time / 1e3);
  };

  examples::Table table({"dial", "bucket", "shapes a call", "in flight", "cache", "calls",
                         "tests a ray, primary", "diffuse", "Mtests/s", "primary, Mrays/s",
                         "diffuse, Mrays/s"});
  for (const EngineCase& way : waysOf()) {
    const RayEngineSettings& s = way.settings;
    const std::unique_ptr<RayEngine> engine = makeRayEngine(device, model, s);
    const double first = bestOfEngine(device, *engine, primary, runs);
    const BucketCount one = engine->count();
    const double second = bestOfEngine(device, *engine, diffuse, runs);
    const BucketCount both = engine->count();
    const auto trials = double(runs + 1);
    const double testsOne = double(one.tests) / trials, testsTwo = double(both.tests - one.tests) / trials;
    table.add({way.name, fmt::format("{}", s.bucket), fmt::format("{}", s.shapesPerCall),
               fmt::format("{}", s.inFlight), fmt::format("{}", s.cache),
               fmt::format("{:.0f}", double(both.calls) / trials),
               fmt::format("{:.0f}", testsOne / double(primary.size())),
               fmt::format("{:.0f}", testsTwo / double(diffuse.size())),
               fmt::format("{:.0f}", (testsOne + testsTwo) / (first + second) / 1e3), rate(primary, first),
               rate(diffuse, second)});
  }
  const auto addEngine = [&](const char* name, Engine& engine) {
    table.add({name, "-", "-", "-", "-", "-", "-", "-", "-",
               rate(primary, bestOfEngine(device, engine, primary, runs)),
               rate(diffuse, bestOfEngine(device, engine, diffuse, runs))});
  };
  addEngine("a grid, branching", *makeStreamingEngine(device, model, {}));
  addEngine("a hierarchy of boxes", *hierarchy);
  const std::unique_ptr<RayEngine> engine = makeRayEngine(device, model, {});
  return {fmt::format("{} triangles\n{}", model.triangles.size(), table.markdown()),
          {checkEngine(*engine, model, side, side)}};
}

}  // namespace rays
