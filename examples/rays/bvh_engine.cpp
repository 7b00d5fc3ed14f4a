// SPDX-License-Identifier: MIT
#include "bvh_engine.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bvh.sk.hpp"
#include "bvh_tracer.hpp"
#include "device_scene.hpp"
#include "path_renderer.hpp"
#include "ray_streams.hpp"
#include "streaming_renderer.hpp"

namespace rays {
namespace {

using examples::Range;
using examples::SceneTable;

constexpr std::array<std::string_view, 3> traversalNames = {"stack", "leaves", "skip"};
constexpr std::array<std::string_view, 2> machineNames = {"megakernel", "wavefront"};
constexpr std::array<std::string_view, 3> sortNames = {"none", "origin", "direction"};
constexpr std::array<std::string_view, 2> intersectionNames = {"watertight", "moller"};
constexpr std::array<std::string_view, 3> precisionNames = {"single", "double", "extended"};
constexpr std::array precisions = {sk::Precision::Single, sk::Precision::Double, sk::Precision::Extended};
constexpr std::array<std::string_view, 2> storageNames = {"single", "half"};
/// Rays of one call; more come in several.
constexpr std::size_t batch = std::size_t{1} << 20;

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
      return makeMultipassRenderer(scene_.view(), tracer_, picture, Use::Paths);
    return makePathRenderer(scene_, picture);
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
  settings.intersection =
      static_cast<HowToIntersect>(table.choice("intersection", intersectionNames).value_or(0));
  settings.machine = static_cast<PathMachine>(table.choice("machine", machineNames).value_or(0));
  settings.sort = static_cast<RaySort>(table.choice("sort", sortNames).value_or(0));
  settings.precision = precisions[table.choice("precision", precisionNames).value_or(0)];
  settings.storage = static_cast<VertexStorage>(table.choice("storage", storageNames).value_or(0));
  settings.bvh.bins = static_cast<int>(table.integer("bins", Range{2, 64}).value_or(settings.bvh.bins));
  settings.bvh.leaf = static_cast<int>(table.integer("leaf", Range{1, 7}).value_or(settings.bvh.leaf));
  return settings;
}

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

}  // namespace rays
