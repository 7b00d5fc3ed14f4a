// SPDX-License-Identifier: MIT
//
// The engine that one would use today: a hierarchy of boxes, and kernels that go through it from the first box to the nearest hit.
#pragma once

#include <memory>
#include <optional>

#include "device_scene.hpp"
#include "engine.hpp"
#include "ray_streams.hpp"
#include "support/scene_file.hpp"

namespace rays {

/// Rays that are on the device already, through a hierarchy of boxes.
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

/// [bvh]: traversal = "stack", "leaves" or "skip", intersection = "watertight" or "moller", precision = "single" or "double", bins, leaf.
MakeEngine readBvhEngine(const std::optional<examples::SceneTable>& settings);

/// The engine itself, for tests and studies.
std::unique_ptr<Engine> makeBvhEngine(sk::Device& device, const Model& model, const DeviceSettings& settings);

}  // namespace rays
