// SPDX-License-Identifier: MIT
#include "bvh_engine.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bvh.sk.hpp"
#include "device_scene.hpp"
#include "path_renderer.hpp"

namespace rays {
namespace {

using examples::Range;
using examples::SceneTable;

constexpr std::array<std::string_view, 3> traversalNames = {"stack", "leaves", "skip"};
constexpr std::array<std::string_view, 2> intersectionNames = {"watertight", "moller"};
/// Rays of one call; more come in several.
constexpr std::size_t batch = std::size_t{1} << 20;

class BvhEngine : public Engine {
 public:
  BvhEngine(sk::Device& device, const Model& model, const DeviceSettings& settings)
      : scene_(device, model, settings) {}

  void closest(std::span<const Ray> rays, std::span<Hit> hits) override {
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::size_t count = std::min(batch, rays.size() - first);
      upload(rays.subspan(first, count));
      sk::Stream<sk::float3> hit = scene_.device().stream<sk::float3>(from_.shape());
      sk::Stream<int> id = scene_.device().stream<int>(from_.shape());
      scene_.call(kernels::closest, from_, along_, hit, id);
      const std::vector<sk::float3> tuv = hit.read();
      const std::vector<int> ids = id.read();
      for (std::size_t i = 0; i < count; ++i)
        hits[first + i] = ids[i] < 0 ? Hit{} : Hit{ids[i], tuv[i].x, tuv[i].y, tuv[i].z};
    }
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) override {
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::size_t count = std::min(batch, rays.size() - first);
      upload(rays.subspan(first, count));
      sk::Stream<std::uint8_t> result = scene_.device().stream<std::uint8_t>(from_.shape());
      scene_.call(kernels::occluded, from_, along_, result);
      result.read(blocked.subspan(first, count));
    }
  }

  std::unique_ptr<Renderer> renderer(const Picture& picture) override {
    return makePathRenderer(scene_, picture);
  }

  std::vector<std::string> account() override { return scene_.account(); }

 private:
  void upload(std::span<const Ray> rays) {
    std::vector<sk::float4> from, along;
    for (const Ray& r : rays) {
      from.push_back({r.origin.x, r.origin.y, r.origin.z, r.least});
      along.push_back({r.direction.x, r.direction.y, r.direction.z, r.most});
    }
    const sk::Shape shape{static_cast<std::int64_t>(rays.size())};
    from_ = scene_.device().stream<sk::float4>(shape);
    along_ = scene_.device().stream<sk::float4>(shape);
    from_.write(from);
    along_.write(along);
  }

  DeviceScene scene_;
  sk::Stream<sk::float4> from_, along_;
};

DeviceSettings settingsOf(const SceneTable& table) {
  DeviceSettings settings;
  if (const auto choice = table.choice("traversal", traversalNames))
    settings.traversal = static_cast<HowToTraverse>(*choice);
  settings.intersection =
      static_cast<HowToIntersect>(table.choice("intersection", intersectionNames).value_or(0));
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
