// SPDX-License-Identifier: MIT
//
// A uniform grid and its shapes on a device.
#pragma once

#include <string>
#include <utility>

#include <sk/sk.hpp>

#include "device_shapes.hpp"
#include "grid.hpp"
#include "model.hpp"
#include "streaming.sk.hpp"

namespace rays {

struct GridScene : DeviceShapes {
  GridScene(sk::Device& onDevice, const Model& ofModel, const GridSettings& settings,
            HowToIntersect howToIntersect);

  /// The arguments that kernels with a whole way through the grid begin with, up to the shapes, and then `more`.
  template <class Kernel, class... More>
  void call(const Kernel& kernel, More&&... more) {
    kernel(static_cast<unsigned>(intersection), contracted, hasTriangles, hasSpheres, hasPlanes, grid,
           planeCount, firstPlane, planes, cells, lists, shapes.floats, shapes.halves, shapes.numbers,
           std::forward<More>(more)...);
  }

  HowToIntersect intersection;
  kernels::Grid grid{};
  sk::Stream<int> cells, lists;
  std::string size;  ///< for the report; empty where there are no shapes
};

}  // namespace rays
