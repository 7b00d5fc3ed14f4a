// SPDX-License-Identifier: MIT
#include "bvh_engine.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include <sk/algorithm.hpp>

#include "bvh.sk.hpp"
#include "device_scene.hpp"
#include "path_tables.hpp"
#include "ray_streams.hpp"
#include "streaming_renderer.hpp"
#include "wavefront.sk.hpp"

namespace rays {
namespace {

using examples::Range;
using examples::SceneTable;

constexpr std::array<std::string_view, 3> traversalNames = {"stack", "leaves", "skip"};
constexpr std::array<std::string_view, 2> machineNames = {"megakernel", "wavefront"};
constexpr std::array<std::string_view, 3> sortNames = {"none", "origin", "direction"};
constexpr std::array<std::string_view, 2> intersectionNames = {"watertight", "moller"};
constexpr std::array<std::string_view, 2> storageNames = {"single", "half"};
/// Rays of one call; more come in several.
constexpr std::size_t batch = std::size_t{1} << 20;

/// Path tracing by one kernel.
class PathRenderer : public PathsRenderer {
 public:
  PathRenderer(DeviceScene& scene, const Picture& picture)
      : PathsRenderer(scene.shapes(), picture), scene_(scene) {}

  void pass(std::int64_t index) override {
    passBy([&](auto& radiance) { scene_.callWith(scene(), kernels::followPaths, sample(index), radiance); });
  }

 private:
  DeviceScene& scene_;
};

class BvhEngine : public Engine {
 public:
  BvhEngine(sk::Device& device, const Model& model, const DeviceSettings& settings)
      : scene_(device, model, settings), settings_(settings), tracer_(scene_, settings.sort) {}

  void closest(std::span<const Ray> rays, std::span<Hit> hits) override {
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::size_t count = std::min(batch, rays.size() - first);
      const auto [from, along] = uploadRays(scene_.device(), rays.subspan(first, count));
      if (settings_.sort != RaySort::None) {
        sk::Stream<kernels::Found> found = scene_.device().stream<kernels::Found>(from.shape());
        tracer_.find(false, from, along, found);
        std::ranges::transform(found.read(), hits.begin() + static_cast<std::ptrdiff_t>(first), hitOf);
        continue;
      }
      sk::Stream<sk::float3> hit = scene_.device().stream<sk::float3>(from.shape());
      sk::Stream<int> id = scene_.device().stream<int>(from.shape());
      scene_.call(kernels::closest, from, along, hit, id);
      const std::vector<sk::float3> tuv = hit.read();
      const std::vector<int> ids = id.read();
      for (std::size_t i = 0; i < count; ++i)
        hits[first + i] = ids[i] < 0 ? Hit{} : Hit{ids[i], tuv[i].x, tuv[i].y, tuv[i].z};
    }
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) override {
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::size_t count = std::min(batch, rays.size() - first);
      const auto [from, along] = uploadRays(scene_.device(), rays.subspan(first, count));
      sk::Stream<std::uint8_t> result = scene_.device().stream<std::uint8_t>(from.shape());
      scene_.call(kernels::occluded, from, along, result);
      result.read(blocked.subspan(first, count));
    }
  }

  std::unique_ptr<Renderer> renderer(const Picture& picture) override {
    if (settings_.machine == PathMachine::Wavefront)
      return makeMultipassRenderer(scene_.shapes(), tracer_, picture, Use::Paths);
    return std::make_unique<PathRenderer>(scene_, picture);
  }

  std::vector<std::string> account() override { return scene_.account(); }
  const Model& model() const override { return scene_.model(); }
  TriangleTest triangleTest() const override {
    return {settings_.intersection == HowToIntersect::Watertight, roundoffOf(settings_.precision)};
  }
  std::vector<std::string> warnings() const override { return scene_.warnings(); }

 private:
  static double roundoffOf(sk::Precision precision) {
    // Pairs of floats lose a few of their 48 bits in each operation.
    return precision == sk::Precision::Double     ? 0x1p-53
           : precision == sk::Precision::Extended ? 0x1p-44
                                                  : 0x1p-24;
  }

  static Hit hitOf(const kernels::Found& f) {
    return f.which.x < 0 ? Hit{} : Hit{f.which.x, f.hit.x, f.hit.y, f.hit.z};
  }

  DeviceScene scene_;
  DeviceSettings settings_;
  BvhTracer tracer_;
};

DeviceSettings settingsOf(const SceneTable& table) {
  DeviceSettings settings;
  if (const auto choice = table.choice("traversal", traversalNames))
    settings.traversal = static_cast<HowToTraverse>(*choice);
  if (const auto nodes = table.integer("nodes", Range{2, wideChildren})) {
    if (*nodes != 2 && *nodes != wideChildren) table.fail("nodes", "'nodes' have 2 or 8 children");
    if (*nodes != 2 && settings.traversal == HowToTraverse::Skip)
      table.fail("nodes",
                 "links past what is missed are for 'nodes' of 2 children; choose another 'traversal'");
    settings.nodes = static_cast<int>(*nodes);
  }
  table.read("intersection", settings.intersection, intersectionNames);
  table.read("machine", settings.machine, machineNames);
  table.read("sort", settings.sort, sortNames);
  settings.precision = table.precision("precision", std::span(examples::precisionNames).subspan(1))
                           .value_or(settings.precision);
  table.read("storage", settings.storage, storageNames);
  table.read("bins", settings.bvh.bins, Range{2, 64});
  table.read("leaf", settings.bvh.leaf, Range{1, 7});
  return settings;
}

/// Cells along each axis that keys tell apart.
constexpr float cells = 512.0f;

float scaleOf(float least, float most) { return cells / std::max(most - least, 0x1p-60f); }

}  // namespace

std::unique_ptr<Engine> makeBvhEngine(sk::Device& device, const Model& model,
                                      const DeviceSettings& settings) {
  return std::make_unique<BvhEngine>(device, model, settings);
}

MakeEngine readBvhEngine(const std::optional<SceneTable>& table) {
  const DeviceSettings settings = table ? settingsOf(*table) : DeviceSettings{};
  return
      [settings](sk::Device& device, const Model& model) { return makeBvhEngine(device, model, settings); };
}

sk::Stream<int> BvhTracer::keys(const sk::Stream<sk::float4>& from,
                                const sk::Stream<sk::float4>& along) const {
  const Bounds box = scene_.bvh().nodes[0].bounds;
  sk::Stream<int> keys = scene_.device().stream<int>(from.shape());
  kernels::rayKeys(sort_ == RaySort::Origin ? 0u : 1u, box.least,
                   sk::float3{scaleOf(box.least.x, box.most.x), scaleOf(box.least.y, box.most.y),
                              scaleOf(box.least.z, box.most.z)},
                   from, along, keys);
  return keys;
}

void BvhTracer::find(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
                     sk::Stream<kernels::Found>& found) {
  if (from.size() == 0) return;
  if (sort_ == RaySort::None || scene_.bvh().nodes.empty())
    scene_.call(kernels::findInHierarchy, anyHit, from, along, found);
  else
    scene_.call(kernels::findInOrder, anyHit, sk::order(keys(from, along)), from, along, found);
}

}  // namespace rays
