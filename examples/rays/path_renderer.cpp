// SPDX-License-Identifier: MIT
#include "path_renderer.hpp"

#include <string>
#include <vector>

#include "path_tables.hpp"

namespace rays {
namespace {

class PathRenderer : public PathsRenderer {
 public:
  PathRenderer(DeviceScene& scene, const Picture& picture)
      : PathsRenderer(scene.device(), scene.model(), picture), scene_(scene) {}

  void pass(std::int64_t index) override {
    const PathTables& t = tables_;
    passBy([&](auto& radiance) {
      scene_.call(kernels::followPaths, features(), static_cast<unsigned>(t.sampling), t.view, t.setting,
                  static_cast<std::uint32_t>(index), t.seed, t.materials, t.corners, t.lights, t.sky,
                  t.texels, t.textures, pixels(), radiance);
    });
  }

 private:
  DeviceScene& scene_;
};

}  // namespace

std::unique_ptr<Renderer> makePathRenderer(DeviceScene& scene, const Picture& picture) {
  return std::make_unique<PathRenderer>(scene, picture);
}

}  // namespace rays
