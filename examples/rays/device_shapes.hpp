// SPDX-License-Identifier: MIT
//
// A model's shapes on a device, in the order of their numbers: triangles before spheres.
#pragma once

#include <sk/sk.hpp>

#include "device_scene.hpp"
#include "model.hpp"

namespace rays {

struct DeviceShapes {
  /// Both must outlive it.
  DeviceShapes(sk::Device& onDevice, const Model& ofModel);

  ShapeView view() const { return {device, model, hasTriangles, hasSpheres, planes, shapes}; }
  bool hasShapes() const { return hasTriangles || hasSpheres; }

  sk::Device& device;
  const Model& model;
  bool contracted;  ///< the device may contract products and sums
  bool hasTriangles, hasSpheres, hasPlanes;
  int planeCount, firstPlane;
  sk::Stream<sk::float4> planes;
  ShapeStreams shapes;
};

}  // namespace rays
