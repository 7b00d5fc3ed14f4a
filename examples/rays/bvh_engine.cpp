// SPDX-License-Identifier: MIT
#include "bvh_engine.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "bvh.sk.hpp"
#include "device_scene.hpp"
#include "path_renderer.hpp"
#include "ray_streams.hpp"

namespace rays {
namespace {

using examples::Range;
using examples::SceneTable;

constexpr std::array<std::string_view, 3> traversalNames = {"stack", "leaves", "skip"};
constexpr std::array<std::string_view, 2> intersectionNames = {"watertight", "moller"};
constexpr std::array<std::string_view, 2> precisionNames = {"single", "double"};
/// Rays of one call; more come in several.
constexpr std::size_t batch = std::size_t{1} << 20;

class BvhEngine : public Engine {
 public:
  BvhEngine(sk::Device& device, const Model& model, const DeviceSettings& settings)
      : scene_(device, model, settings) {}

  void closest(std::span<const Ray> rays, std::span<Hit> hits) override {
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::size_t count = std::min(batch, rays.size() - first);
      const auto [from, along] = uploadRays(scene_.device(), rays.subspan(first, count));
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
    return makePathRenderer(scene_, picture);
  }

  std::vector<std::string> account() override { return scene_.account(); }

 private:
  DeviceScene scene_;
};

DeviceSettings settingsOf(const SceneTable& table) {
  DeviceSettings settings;
  if (const auto choice = table.choice("traversal", traversalNames))
    settings.traversal = static_cast<HowToTraverse>(*choice);
  settings.intersection =
      static_cast<HowToIntersect>(table.choice("intersection", intersectionNames).value_or(0));
  if (table.choice("precision", precisionNames).value_or(0) == 1) settings.precision = sk::Precision::Double;
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
