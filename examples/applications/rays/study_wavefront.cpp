// SPDX-License-Identifier: MIT
//
// Rays in the order in which they come, and sorted; and paths that one kernel follows to their end, or that a call for each segment takes on.
#include "study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <sk/algorithm.hpp>

#include "bvh_engine.hpp"
#include "camera.hpp"
#include "pass_meter.hpp"
#include "ray_streams.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

constexpr std::array sorts = {std::pair{RaySort::None, "none"}, std::pair{RaySort::Origin, "origin"},
                              std::pair{RaySort::Direction, "direction"}};

/// Millions of rays a second: `whole` includes the sort, if there is one; `sortedBefore` traces rays that were sorted beforehand (NaN without
/// a sort).
struct WavefrontRates {
  double whole, sortedBefore;
};

std::vector<Ray> sortedRays(sk::Device& device, const BvhTracer& tracer, const std::vector<Ray>& rays) {
  const RayStreams streams = uploadRays(device, rays);
  std::vector<Ray> sorted;
  for (const int i : sk::order(tracer.keys(streams.from, streams.along)).read())
    sorted.push_back(rays[static_cast<std::size_t>(i)]);
  return sorted;
}

WavefrontRates ratesOf(DeviceScene& scene, RaySort sort, const std::vector<Ray>& rays, int calls) {
  sk::Device& device = scene.device();
  const auto rate = [&](BvhTracer tracer, const std::vector<Ray>& list) {
    const RayStreams streams = uploadRays(device, list);
    auto found = device.stream<kernels::Found>(streams.from.shape());
    return callRate(device, double(list.size()), calls,
                    [&] { tracer.find(false, streams.from, streams.along, found); });
  };
  const BvhTracer tracer(scene, sort);
  if (sort == RaySort::None) return {rate(tracer, rays), NAN};
  return {rate(tracer, rays), rate(BvhTracer(scene, RaySort::None), sortedRays(device, tracer, rays))};
}

std::string tableOfSorts(sk::Device& device, const Model& model, const std::vector<Ray>& primary,
                         const std::vector<Ray>& diffuse, int calls) {
  examples::Table table({"sort", "primary, M/s", "sorted before", "diffuse, M/s", "sorted before"});
  DeviceScene scene(device, model, {});
  const auto text = [](double rate) {
    return std::isnan(rate) ? std::string("-") : fmt::format("{:.2f}", rate);
  };
  for (const auto& [sort, name] : sorts) {
    const WavefrontRates first = ratesOf(scene, sort, primary, calls),
                         second = ratesOf(scene, sort, diffuse, calls);
    table.add(
        {name, text(first.whole), text(first.sortedBefore), text(second.whole), text(second.sortedBefore)});
  }
  return table.markdown();
}

}  // namespace

Findings studyWavefront(sk::Device& device, bool isSmall) {
  const int side = isSmall ? 32 : device.isSoftware() ? 128 : runsOnProcessor(device) ? 256 : 1024;
  const int calls = isSmall ? 1 : runsOnProcessor(device) ? 3 : 20;
  Model model = interior(isSmall);
  // Light that comes from everywhere within, so that paths end by chance alone.
  model.materials[0].emission = {0.1f, 0.1f, 0.1f};
  const std::vector<Ray> primary = primaryRays(model.camera, side, side);
  const std::vector<Hit> hits = hitsOf(*makeBvhEngine(device, model, {}), primary);
  Findings findings;
  findings.table =
      tableOfSorts(device, model, primary, diffuseRays(model, primary, hits, primary.size()), calls) + "\n";

  examples::Table table({"machine", "sort", "ms a sample", "Mpaths/s"});
  examples::Verification same("difference of pictures by both machines, of their mean", 1e-3,
                              "contraction may round a path's numbers differently, and its way with them");
  const Picture picture{.width = side, .height = side, .depth = 8};
  std::vector<sk::float3> expected;
  for (const auto& [machine, sort, names] :
       {std::tuple{PathMachine::Megakernel, RaySort::None, std::pair{"megakernel", "-"}},
        std::tuple{PathMachine::Wavefront, RaySort::None, std::pair{"wavefront", "none"}},
        std::tuple{PathMachine::Wavefront, RaySort::Origin, std::pair{"wavefront", "origin"}},
        std::tuple{PathMachine::Wavefront, RaySort::Direction, std::pair{"wavefront", "direction"}}}) {
    const std::unique_ptr<Engine> engine = makeBvhEngine(device, model, {.machine = machine, .sort = sort});
    const std::unique_ptr<Renderer> renderer = engine->renderer(picture);
    int sample = 0;
    const double time = bestMilliseconds(device, calls, [&] { renderer->pass(sample++ % 16); });
    table.add({names.first, names.second, fmt::format("{:.2f}", time),
               fmt::format("{:.2f}", double(side) * side / time / 1e3)});
    const std::unique_ptr<Renderer> fresh = engine->renderer(picture);
    for (int i = 0; i < 4; ++i) fresh->pass(i);
    const std::vector<sk::float3> image = fresh->image();
    if (expected.empty()) expected = image;
    double sum = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
      sum += expected[i].y;
      difference += image[i].y - expected[i].y;
    }
    same.note(static_cast<std::int64_t>(sort), std::abs(difference) / sum);
  }
  findings.table += table.markdown();
  findings.verifications = {same};
  return findings;
}

}  // namespace rays
