// SPDX-License-Identifier: MIT
//
// Pictures of the water in its pool, computed on its device.
#pragma once

#include "scene.hpp"
#include "support/image.hpp"
#include "surface.hpp"

namespace waves {

class Painter {
 public:
  Painter(sk::Device& device, const Scene& scene);

  /// If the surface is divided over ranks, all must call it; those other than the first get an empty picture.
  examples::Image paint(const Surface& surface);

 private:
  sk::Device& device_;
  const Scene& scene_;
  examples::Gathered<float> gathered_;
  sk::Stream<sk::float3> photons_;  ///< where they enter the water: x, y, and 1
  sk::Stream<float> light_;  ///< of the floor: 1 where the water is flat
};

}  // namespace waves
