// SPDX-License-Identifier: MIT
//
// A uniform grid and its shapes on a device.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sk/sk.hpp>

#include "device_scene.hpp"
#include "grid.hpp"
#include "model.hpp"
#include "streaming.sk.hpp"

namespace rays {

class GridScene {
 public:
  GridScene(sk::Device& device, const Model& model, const GridSettings& settings, HowToIntersect intersection);

  /// The arguments that kernels with a whole way through the grid begin with, up to `shapes`, and then `more`.
  template <class Kernel, class... More>
  void call(const Kernel& kernel, More&&... more) {
    kernel(static_cast<unsigned>(intersection), contracted, hasTriangles, hasSpheres, hasPlanes, grid, planeCount,
           firstPlane, planes, cells, lists, shapes, std::forward<More>(more)...);
  }

  bool hasShapes() const { return hasTriangles || hasSpheres; }
  std::vector<std::string> account() const;

  sk::Device& device;
  const Model& model;
  HowToIntersect intersection;
  bool contracted, hasTriangles, hasSpheres, hasPlanes;
  int planeCount, firstPlane;
  kernels::Grid grid{};
  sk::Stream<sk::float4> planes, shapes;
  sk::Stream<int> cells, lists;

 private:
  std::string size_;
};

}  // namespace rays
