// SPDX-License-Identifier: MIT
//
// What a paper on the streaming tracer would show: the steps of rays through grids, passes and bytes of both machines, and the price of each kernel.
#include "study.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "bvh_engine.hpp"
#include "camera.hpp"
#include "grid_tracer.hpp"
#include "pass_meter.hpp"
#include "ray_streams.hpp"
#include "reference.hpp"
#include "streaming_engine.hpp"
#include "streaming_renderer.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

std::string rateText(std::int64_t rays, double time) {
  return fmt::format("{:.2f}", double(rays) / time / 1e3);
}

struct Steps {
  double cells = 0.0, tests = 0.0;  ///< means
  int most = 0;  ///< of both together, of one ray
};

Steps stepsOf(GridScene& scene, const RayStreams& rays) {
  auto steps = scene.device.stream<sk::int2>(rays.from.shape());
  kernels::stepsInGrid(scene.scene(), scene.grid(), false, rays.from, rays.along, steps);
  Steps result;
  const std::vector<sk::int2> all = steps.read();
  for (const sk::int2& s : all) {
    result.cells += double(s.x) / double(all.size());
    result.tests += double(s.y) / double(all.size());
    result.most = std::max(result.most, s.x + s.y);
  }
  return result;
}

/// Grids of several densities, and a hierarchy, for the rays of a camera and those that what they hit scatters.
std::string tableOfSteps(sk::Device& device, const Model& model, const std::array<std::vector<Ray>, 2>& rays,
                         int runs) {
  const std::array<RayStreams, 2> streams = {uploadRays(device, rays[0]), uploadRays(device, rays[1])};
  examples::Table table({"structure, machine", "cells, primary", "tests", "most steps", "cells, diffuse",
                         "tests", "most steps", "primary, Mrays/s", "diffuse, Mrays/s"});
  const auto add = [&](double density, Machine machine) {
    GridScene scene(device, model, {.density = density}, HowToIntersect::Watertight);
    GridTracer tracer(scene, {.machine = machine});
    std::vector<std::string> cells = {fmt::format("grid, {:g} cells a shape, {}", density,
                                                  machine == Machine::Branching ? "branching" : "multipass")};
    for (const RayStreams& some : streams) {
      const Steps steps = stepsOf(scene, some);
      cells.push_back(fmt::format("{:.1f}", steps.cells));
      cells.push_back(fmt::format("{:.1f}", steps.tests));
      cells.push_back(fmt::format("{}", steps.most));
    }
    for (const RayStreams& some : streams) {
      auto found = device.stream<kernels::Found>(some.from.shape());
      cells.push_back(rateText(some.from.size(), bestMilliseconds(device, runs, [&] {
                                 tracer.find(false, some.from, some.along, found);
                               })));
    }
    table.add(cells);
  };
  for (const double density : {0.5, 4.0, 32.0}) add(density, Machine::Branching);
  add(4.0, Machine::Multipass);
  DeviceScene hierarchy(device, model, {});
  std::vector<std::string> cells = {"hierarchy of boxes", "-", "-", "-", "-", "-", "-"};
  for (const RayStreams& some : streams) {
    auto hit = device.stream<sk::float3>(some.from.shape());
    auto id = device.stream<int>(some.from.shape());
    cells.push_back(rateText(some.from.size(), bestMilliseconds(device, runs, [&] {
                               hierarchy.call(kernels::closest, some.from, some.along, hit, id);
                             })));
  }
  table.add(cells);
  return table.markdown();
}

/// How much a multipass call does, how often rays are counted, and when they are compacted.
std::string tableOfDials(GridScene& scene, const std::vector<Ray>& rays, int runs) {
  const RayStreams streams = uploadRays(scene.device, rays);
  auto found = scene.device.stream<kernels::Found>(streams.from.shape());
  examples::Table table(
      {"shapes a call", "calls until rays are counted", "compacted at", "calls", "primary, Mrays/s"});
  const auto add = [&](const StreamingSettings& s) {
    PassMeter meter(scene.device);
    GridTracer(scene, s, &meter).find(false, streams.from, streams.along, found);
    std::int64_t calls = 0;
    for (const PassMeter::Row& row : meter.rows()) calls += row.calls;
    GridTracer tracer(scene, s);
    const double best =
        bestMilliseconds(scene.device, runs, [&] { tracer.find(false, streams.from, streams.along, found); });
    table.add({fmt::format("{}", s.tests), fmt::format("{}", 2 * s.rounds),
               fmt::format("{:.0f} %", 100 * s.compact), fmt::format("{}", calls),
               rateText(streams.from.size(), best)});
  };
  const StreamingSettings defaults{.machine = Machine::Multipass};
  add(defaults);
  const auto changed = [&](const auto& change) {
    StreamingSettings s = defaults;
    change(s);
    add(s);
  };
  for (const int tests : {1, 2, 16}) changed([&](StreamingSettings& s) { s.tests = tests; });
  for (const int rounds : {1, 2, 32}) changed([&](StreamingSettings& s) { s.rounds = rounds; });
  for (const double compact : {0.0, 0.25, 0.5, 1.0})
    changed([&](StreamingSettings& s) { s.compact = compact; });
  return table.markdown();
}

sk::PassCount sumOf(const PassMeter& meter) {
  sk::PassCount sum;
  for (const PassMeter::Row& row : meter.rows()) {
    sum.passes += row.count.passes;
    sum.bytesRead += row.count.bytesRead;
    sum.bytesWritten += row.count.bytesWritten;
  }
  return sum;
}

std::string mebibytes(std::int64_t bytes) { return fmt::format("{:.1f}", double(bytes) / double(1 << 20)); }

/// A sample of each pixel, for what paths may do, by both machines.
std::string tableOfUses(GridScene& scene, const Picture& picture, int runs) {
  constexpr std::array<std::string_view, 4> names = {"path tracing", "Whitted", "shadow casting",
                                                     "ray casting"};
  examples::Table table({"use", "machine", "passes", "MiB read", "MiB written", "ms"});
  for (const Use use : {Use::RayCasting, Use::ShadowCasting, Use::Whitted, Use::Paths}) {
    for (const Machine machine : {Machine::Branching, Machine::Multipass}) {
      PassMeter meter(scene.device);
      GridTracer counted(scene, {.machine = machine}, &meter), tracer(scene, {.machine = machine});
      const bool isBranching = machine == Machine::Branching;
      const std::unique_ptr<Renderer> renderer =
          isBranching ? makeBranchingRenderer(scene, picture, use)
                      : makeMultipassRenderer(scene, tracer, picture, use);
      if (isBranching)
        meter.measure("all", 0, [&] { renderer->pass(0); });
      else
        makeMultipassRenderer(scene, counted, picture, use, &meter)->pass(0);
      const sk::PassCount count = sumOf(meter);
      const double best = bestMilliseconds(scene.device, runs, [&] { renderer->pass(0); });
      table.add({std::string(names[static_cast<std::size_t>(use)]), isBranching ? "branching" : "multipass",
                 fmt::format("{}", count.passes), mebibytes(count.bytesRead), mebibytes(count.bytesWritten),
                 fmt::format("{:.0f}", best)});
    }
  }
  return table.markdown();
}

/// One sample of path tracing by the multipass machine.
std::string tableOfKernels(GridScene& scene, const Picture& picture) {
  PassMeter meter(scene.device);
  GridTracer tracer(scene, {.machine = Machine::Multipass}, &meter);
  const std::unique_ptr<Renderer> renderer =
      makeMultipassRenderer(scene, tracer, picture, Use::Paths, &meter);
  renderer->pass(0);
  meter.forget();
  renderer->pass(0);
  double all = 0.0;
  for (const PassMeter::Row& row : meter.rows()) all += row.milliseconds;
  examples::Table table(
      {"kernel", "calls", "passes", "elements a pixel", "bytes written an element", "part of the time"});
  const double pixels = double(picture.width) * picture.height;
  for (const PassMeter::Row& row : meter.rows()) {
    const auto elements = double(std::max<std::int64_t>(row.elements, 1));
    table.add({std::string(row.kernel), fmt::format("{}", row.calls), fmt::format("{}", row.count.passes),
               fmt::format("{:.1f}", double(row.elements) / pixels),
               fmt::format("{:.1f}", double(row.count.bytesWritten) / elements),
               fmt::format("{:.0f} %", 100.0 * row.milliseconds / all)});
  }
  return table.markdown();
}

/// The model with a mirror, a sun and a sky, so that each use has something to do.
Model litModel(Model model) {
  model.materials.push_back({.name = "mirror", .scattering = Scattering::Mirror});
  for (std::size_t i = 0; i < model.triangles.size() / 3; ++i) model.triangles[i].material = 1;
  model.suns.push_back({toFloat3(normalized(Vector{1, 2, 1})), {2, 2, 2}, 0.0f});
  model.environment.colour = {0.2f, 0.3f, 0.4f};
  return model;
}

}  // namespace

Findings studyStreaming(sk::Device& device, bool isSmall) {
  const int side = isSmall ? 32 : 256, runs = isSmall ? 1 : 5;
  Model model = litModel(speedModel(isSmall));
  const std::vector<Ray> primary = primaryRays(model.camera, side, side);
  const std::unique_ptr<Engine> engine = makeStreamingEngine(device, model, {});
  const std::vector<Hit> hits = hitsOf(*engine, primary);
  GridScene scene(device, model, {}, HowToIntersect::Watertight);
  const Picture picture{.width = side, .height = side, .depth = 4};
  Findings findings;
  findings.table =
      tableOfSteps(device, model, {primary, diffuseRays(model, primary, hits, primary.size())}, runs) + "\n" +
      tableOfDials(scene, primary, runs) + "\n" + tableOfUses(scene, picture, runs) + "\n" +
      tableOfKernels(scene, picture);
  findings.verifications.push_back(checkEngine(*engine, model, side, side));
  return findings;
}

}  // namespace rays
