// SPDX-License-Identifier: MIT
#include "path_renderer.hpp"

#include <string>
#include <vector>

#include "path_tables.hpp"

namespace rays {
namespace {

class PathRenderer : public Renderer {
 public:
  PathRenderer(DeviceScene& scene, const Picture& picture)
      : scene_(scene), tables_(scene.device(), scene.model(), picture), exposure_(scene.device(), picture) {}

  void pass(std::int64_t index) override {
    PathTables& t = tables_;
    scene_.call(kernels::followPaths, t.features, static_cast<unsigned>(t.sampling), t.view, t.setting,
                static_cast<std::uint32_t>(index), t.seed, t.materials, t.corners, t.lights, t.sky, t.texels,
                t.textures, exposure_.radiance);
    exposure_.add();
  }

  std::vector<sk::float3> image() override { return exposure_.image(); }

  std::vector<sk::float3> variance() override { return exposure_.variance(); }

  std::vector<std::string> account() override { return {tables_.account()}; }

 private:
  DeviceScene& scene_;
  PathTables tables_;
  Exposure exposure_;
};

}  // namespace

std::unique_ptr<Renderer> makePathRenderer(DeviceScene& scene, const Picture& picture) {
  return std::make_unique<PathRenderer>(scene, picture);
}

}  // namespace rays
