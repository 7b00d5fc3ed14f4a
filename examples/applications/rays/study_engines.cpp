// SPDX-License-Identifier: MIT
//
// What twenty years of data structures are worth: rays against all triangles, through a grid, and through a hierarchy, in the scenes of the
// benchmarks.
#include "study.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "camera.hpp"
#include "grid_tracer.hpp"
#include "pass_meter.hpp"
#include "ray_engine.hpp"
#include "ray_streams.hpp"
#include "reference.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

struct Rates {
  double primary, diffuse;
};

std::string textOf(double rate) { return fmt::format("{:.{}f}", rate, rate < 1 ? 3 : 2); }

/// What a tracer does with rays that are on the device already.
Rates ratesBy(sk::Device& device, StreamTracer& tracer, const std::array<std::vector<Ray>, 2>& rays,
              int calls) {
  std::array<double, 2> rates{};
  for (std::size_t i = 0; i < 2; ++i) {
    const RayStreams streams = uploadRays(device, rays[i]);
    auto found = device.stream<kernels::Found>(streams.from.shape());
    rates[i] = callRate(device, double(rays[i].size()), calls,
                        [&] { tracer.find(false, streams.from, streams.along, found); });
  }
  return {rates[0], rates[1]};
}

/// Every `step`-th, so that a few are of all parts of the picture.
std::vector<Ray> someOf(const std::vector<Ray>& rays, std::size_t step) {
  std::vector<Ray> some;
  for (std::size_t i = 0; i < rays.size(); i += step) some.push_back(rays[i]);
  return some;
}

}  // namespace

Findings studyEngines(sk::Device& device, bool isSmall) {
  const int side = isSmall ? 32 : device.isSoftware() ? 128 : runsOnProcessor(device) ? 256 : 1024;
  const int calls = isSmall ? 1 : runsOnProcessor(device) ? 3 : 20;
  examples::Table table({"scene", "engine", "primary, Mrays/s", "diffuse, Mrays/s"});
  Findings findings;
  for (const auto& [name, model] :
       {std::pair{"interior", interior(isSmall)}, std::pair{"organic mesh", organic(isSmall)}}) {
    const std::string scene = fmt::format("{}, {} triangles", name, model.triangles.size());
    const std::vector<Ray> primary = primaryRays(model.camera, side, side);
    const std::unique_ptr<Engine> engine = makeBvhEngine(device, model, {});
    const std::vector<Hit> hits = hitsOf(*engine, primary);
    const std::array<std::vector<Ray>, 2> rays = {primary, diffuseRays(model, primary, hits, primary.size())};
    const auto add = [&](const char* how, const Rates& rates) {
      table.add({scene, how, textOf(rates.primary), textOf(rates.diffuse)});
    };

    const std::size_t step = std::max<std::size_t>(1, primary.size() / (isSmall ? 64 : 2048));
    const std::unique_ptr<RayEngine> buckets = makeRayEngine(device, model, {});
    std::array<double, 2> milliseconds{};
    for (std::size_t i = 0; i < 2; ++i) {
      const std::vector<Ray> some = someOf(rays[i], step);
      std::vector<Hit> found(some.size());
      milliseconds[i] =
          rays::milliseconds(device, [&] { buckets->closest(some, found); }) / double(some.size());
    }
    const auto tests = double(buckets->count().tests);
    const double time = (milliseconds[0] + milliseconds[1]) * double(someOf(primary, step).size());
    const double allPairs = tests / time / 1e3 / double(model.triangles.size());
    add("ray engine, rate of all pairs", {allPairs, allPairs});
    add("ray engine", {1e-3 / milliseconds[0], 1e-3 / milliseconds[1]});

    for (const Machine machine : {Machine::Multipass, Machine::Branching}) {
      GridScene grid(device, model, {}, HowToIntersect::Watertight);
      GridTracer tracer(grid, {.machine = machine});
      add(machine == Machine::Branching ? "grid, branching" : "grid, multipass",
          ratesBy(device, tracer, rays, calls));
    }
    DeviceScene hierarchy(device, model, {});
    BvhTracer tracer(hierarchy, RaySort::None);
    add("hierarchy of boxes", ratesBy(device, tracer, rays, calls));
    findings.verifications.push_back(checkEngine(*engine, model, side, side));
  }
  findings.table = table.markdown();
  return findings;
}

}  // namespace rays
