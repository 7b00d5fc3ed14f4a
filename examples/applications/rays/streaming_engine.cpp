// SPDX-License-Identifier: MIT
#include "streaming_engine.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "ray_streams.hpp"
#include "streaming.sk.hpp"
#include "streaming_renderer.hpp"

namespace rays {
namespace {

using examples::Range;
using examples::SceneTable;

constexpr std::array<std::string_view, 2> machineNames = {"branching", "multipass"};
constexpr std::array<std::string_view, 4> useNames = {"paths", "whitted", "shadows", "rays"};
constexpr std::array<std::string_view, 2> intersectionNames = {"watertight", "moller"};
/// Rays of one call; more come in several.
constexpr std::size_t batch = std::size_t{1} << 20;

class StreamingEngine : public Engine {
 public:
  StreamingEngine(sk::Device& device, const Model& model, const StreamingSettings& settings)
      : scene_(device, model, settings.grid, settings.intersection),
        settings_(settings),
        tracer_(scene_, settings) {}

  void closest(std::span<const Ray> rays, std::span<Hit> hits) override {
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::size_t count = std::min(batch, rays.size() - first);
      const std::vector<kernels::Found> found = find(false, rays.subspan(first, count)).read();
      for (std::size_t i = 0; i < count; ++i) {
        const kernels::Found& f = found[i];
        hits[first + i] = f.which.x < 0 ? Hit{} : Hit{f.which.x, f.hit.x, f.hit.y, f.hit.z};
      }
    }
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) override {
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::size_t count = std::min(batch, rays.size() - first);
      const sk::Stream<kernels::Found> found = find(true, rays.subspan(first, count));
      sk::Stream<std::uint8_t> result = scene_.device.stream<std::uint8_t>(found.shape());
      kernels::isBlocked(found, result);
      result.read(blocked.subspan(first, count));
    }
  }

  std::unique_ptr<Renderer> renderer(const Picture& picture) override {
    if (settings_.machine == Machine::Branching) return makeBranchingRenderer(scene_, picture, settings_.use);
    return makeMultipassRenderer(scene_, tracer_, picture, settings_.use);
  }

  std::vector<std::string> account() override {
    if (scene_.size.empty()) return {};
    return {scene_.size};
  }

  const Model& model() const override { return scene_.model; }
  TriangleTest triangleTest() const override {
    return {.isWatertight = settings_.intersection == HowToIntersect::Watertight};
  }

 private:
  sk::Stream<kernels::Found> find(bool anyHit, std::span<const Ray> rays) {
    const auto [from, along] = uploadRays(scene_.device, rays);
    sk::Stream<kernels::Found> found = scene_.device.stream<kernels::Found>(from.shape());
    tracer_.find(anyHit, from, along, found);
    return found;
  }

  GridScene scene_;
  StreamingSettings settings_;
  GridTracer tracer_;
};

StreamingSettings settingsOf(const SceneTable& table) {
  StreamingSettings s;
  table.read("machine", s.machine, machineNames);
  table.read("use", s.use, useNames);
  table.read("intersection", s.intersection, intersectionNames);
  table.read("density", s.grid.density, Range{1e-6, 1000});
  table.read("tests", s.tests, Range{1, 64});
  table.read("rounds", s.rounds, Range{1, 1000});
  table.read("compact", s.compact, Range{0.0, 1.0});
  return s;
}

}  // namespace

std::unique_ptr<Engine> makeStreamingEngine(sk::Device& device, const Model& model,
                                            const StreamingSettings& settings) {
  return std::make_unique<StreamingEngine>(device, model, settings);
}

MakeEngine readStreamingEngine(const std::optional<SceneTable>& table) {
  const StreamingSettings settings = table ? settingsOf(*table) : StreamingSettings{};
  return [settings](sk::Device& device, const Model& model) {
    return makeStreamingEngine(device, model, settings);
  };
}

}  // namespace rays
