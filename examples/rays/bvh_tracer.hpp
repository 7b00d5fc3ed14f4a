// SPDX-License-Identifier: MIT
//
// Rays that are on the device already, through a hierarchy of boxes.
#pragma once

#include "device_scene.hpp"
#include "stream_tracer.hpp"

namespace rays {

class BvhTracer : public StreamTracer {
 public:
  /// `scene` must outlive it.
  BvhTracer(DeviceScene& scene, RaySort sort) : scene_(scene), sort_(sort) {}

  void find(bool anyHit, const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along,
            sk::Stream<kernels::Found>& found) override;

  /// What rays are sorted by; there must be shapes.
  sk::Stream<int> keys(const sk::Stream<sk::float4>& from, const sk::Stream<sk::float4>& along) const;

 private:
  DeviceScene& scene_;
  RaySort sort_;
};

}  // namespace rays
