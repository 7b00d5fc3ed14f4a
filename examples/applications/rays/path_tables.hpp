// SPDX-License-Identifier: MIT
//
// What kernels that follow paths read beside shapes: the scene's features, camera, materials, lights and textures, on a device.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sk/sk.hpp>

#include "device_scene.hpp"
#include "engine.hpp"
#include "exposure.hpp"
#include "model.hpp"
#include "path.sk.hpp"

namespace rays {

struct PathTables {
  PathTables(sk::Device& device, const Model& model, const Picture& picture);

  /// What is compiled, and what is left out.
  std::string account() const;

  /// The scene of these shapes. Refers to the streams of both.
  kernels::Scene scene(const DeviceShapes& shapes) const;

  int features;  ///< bits of Feature in scattering.sk
  kernels::View view;
  int lightCount, sunCount;
  sk::float3 skyColour;
  sk::int2 skySize;
  float skyChoice;
  sk::Stream<sk::float4> materials, corners, lights, sky, texels;
  sk::Stream<sk::int4> textures;
};

/// What renderers of paths share: all but the way of a pass.
class PathsRenderer : public Renderer {
 public:
  /// The shapes must outlive it.
  PathsRenderer(const DeviceShapes& shapes, const Picture& picture)
      : shapes_(shapes),
        tables_(shapes.device, shapes.model, picture),
        exposure_(shapes.device, picture),
        picture_(picture),
        noPixels_(shapes.device.stream<sk::int2>({1})) {}

  void look(const Camera& camera) override;
  Exposure& exposure() override { return exposure_; }
  std::vector<std::string> account() override { return {tables_.account()}; }

 protected:
  /// The scene; if some pixels have stopped, kernels take the list of the others.
  kernels::Scene scene() const;
  /// Sample `index` of the active pixels.
  kernels::Picture sample(std::int64_t index) const;
  /// Calls `follow(radiance)`, a kernel that makes a path of each element, for the active pixels, and adds the samples.
  template <class Follow>
  void passBy(Follow&& follow) {
    if (!exposure_.isSparse()) {
      follow(exposure_.radiance);
    } else if (exposure_.activePixels() > 0) {
      follow(exposure_.list());
      exposure_.deliver();
    }
    exposure_.add();
  }

  const DeviceShapes& shapes_;
  PathTables tables_;
  Exposure exposure_;

 private:
  static constexpr int listed = 16384;  ///< as in scattering.sk

  Picture picture_;
  sk::Stream<sk::int2> noPixels_;  ///< in place of a list; kernels do not read it
};

}  // namespace rays
