// SPDX-License-Identifier: MIT
//
// Rays from a camera, which go side by side, and the diffuse rays from what they hit, which go anywhere.
#include "study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "camera.hpp"
#include "device_scene.hpp"
#include "pass_meter.hpp"
#include "ray_streams.hpp"
#include "reference.hpp"
#include "shapes.hpp"
#include "support/stopwatch.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

struct Streams {
  sk::Stream<sk::float4> from, along;
  sk::Stream<sk::float3> hit;
  sk::Stream<int> id;
};

Streams streamsOf(sk::Device& device, std::span<const Ray> rays) {
  RayStreams streams = uploadRays(device, rays);
  const sk::Shape shape = streams.from.shape();
  return {std::move(streams.from), std::move(streams.along), device.stream<sk::float3>(shape),
          device.stream<int>(shape)};
}

/// In millions a second: the best of some calls, without the way to the device and back.
double rate(DeviceScene& scene, Streams& s, int calls) {
  return callRate(scene.device(), double(s.from.size()), calls,
                  [&] { scene.call(kernels::closest, s.from, s.along, s.hit, s.id); });
}

struct Way {
  HowToTraverse traversal;
  int nodes;
  HowToIntersect how = HowToIntersect::Watertight;
};

constexpr std::array ways = {Way{HowToTraverse::Stack, 2},
                             Way{HowToTraverse::Leaves, 2},
                             Way{HowToTraverse::Skip, 2},
                             Way{HowToTraverse::Stack, 8},
                             Way{HowToTraverse::Leaves, 8},
                             Way{HowToTraverse::Stack, 2, HowToIntersect::Moller},
                             Way{HowToTraverse::Stack, 8, HowToIntersect::Moller}};

}  // namespace

double closestRate(sk::Device& device, const Model& model, std::span<const Ray> rays, int calls) {
  DeviceScene scene(device, model, {});
  Streams streams = streamsOf(device, rays);
  return rate(scene, streams, calls);
}

double bestMilliseconds(sk::Device& device, int calls, const std::function<void()>& call) {
  const auto whole = [&] {
    call();
    device.finish();
  };
  whole();  // compiles
  if (!runsOnProcessor(device)) {
    // A GPU raises its clock only while it has work.
    const examples::Stopwatch stopwatch;
    while (stopwatch.milliseconds() < 400) whole();
  }
  double best = HUGE_VAL;
  for (int i = 0; i < calls; ++i) best = std::min(best, milliseconds(device, whole));
  return best;
}

double callRate(sk::Device& device, double elements, int calls, const std::function<void()>& call) {
  return elements / bestMilliseconds(device, calls, call) / 1e3;
}

Model speedModel(bool isSmall) {
  Model model = modelOf(icosphere(isSmall ? 3 : 6, false));
  const auto add = [&](const Mesh& mesh, double scale, double y) {
    for (Triangle t : modelOf(mesh).triangles) {
      for (sk::float3* p : {&t.a, &t.b, &t.c})
        *p = toFloat3(scale * examples::vecOf<double>(*p) + Vector{0, y, 0});
      t.id = model.triangleCount++;
      model.triangles.push_back(t);
    }
  };
  add(torus(isSmall ? 20 : 100, isSmall ? 12 : 60, 0.15), 2.0, 0.0);
  add(terrain(isSmall ? 4 : 8, 0.3, 1), 4.0, -0.6);
  model.camera.from = {1.2, 1.4, 1.8};
  return model;
}

Findings studySpeed(sk::Device& device, bool isSmall) {
  const int side = isSmall ? 48 : device.isSoftware() ? 256 : runsOnProcessor(device) ? 512 : 1024;
  const Model model = speedModel(isSmall);
  const std::vector<Ray> primary = primaryRays(model.camera, side, side);
  examples::Table table(
      {"test", "traversal", "nodes of", "leaf", "nodes", "cost", "primary, M/s", "diffuse, M/s"});
  const int calls = isSmall ? 1 : runsOnProcessor(device) ? 5 : 20;
  for (const Way& way : ways) {
    for (const int leaf : {1, 2, 4}) {
      const DeviceSettings settings{
          .bvh = {.leaf = leaf}, .traversal = way.traversal, .nodes = way.nodes, .intersection = way.how};
      const std::unique_ptr<Engine> engine = makeBvhEngine(device, model, settings);
      const std::vector<Hit> hits = hitsOf(*engine, primary);
      DeviceScene scene(device, model, settings);
      Streams first = streamsOf(device, primary),
              second = streamsOf(device, diffuseRays(model, primary, hits, primary.size()));
      table.add({way.how == HowToIntersect::Watertight ? "watertight" : "moller",
                 std::string(nameOf(way.traversal)), fmt::format("{}", way.nodes), fmt::format("{}", leaf),
                 fmt::format("{}", scene.nodeCount()), fmt::format("{:.0f}", scene.bvh().cost),
                 fmt::format("{:.2f}", rate(scene, first, calls)),
                 fmt::format("{:.2f}", rate(scene, second, calls))});
    }
  }
  const std::unique_ptr<Engine> engine = makeBvhEngine(device, model, {});
  return {table.markdown(), {checkEngine(*engine, model, side, side)}};
}

}  // namespace rays
