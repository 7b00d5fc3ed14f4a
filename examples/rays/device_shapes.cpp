// SPDX-License-Identifier: MIT
#include "device_shapes.hpp"

#include <cstdint>
#include <numeric>
#include <vector>

namespace rays {
namespace {

std::vector<std::uint32_t> ownOrder(const Model& model) {
  std::vector<std::uint32_t> order(model.triangles.size() + model.spheres.size());
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

}  // namespace

DeviceShapes::DeviceShapes(sk::Device& onDevice, const Model& ofModel)
    : device(onDevice),
      model(ofModel),
      contracted(!onDevice.name().starts_with("native")),
      hasTriangles(!ofModel.triangles.empty()),
      hasSpheres(!ofModel.spheres.empty()),
      hasPlanes(!ofModel.planes.empty()),
      planeCount(static_cast<int>(ofModel.planes.size())),
      firstPlane(ofModel.planeId(0)),
      planes(streamOf(onDevice, planeLayout(ofModel))),
      shapes(onDevice, ownOrder(ofModel), ofModel) {}

}  // namespace rays
