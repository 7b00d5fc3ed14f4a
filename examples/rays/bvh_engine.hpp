// SPDX-License-Identifier: MIT
//
// The engine that one would use today: a hierarchy of boxes, and kernels that go through it from the first box to the nearest hit.
#pragma once

#include <memory>
#include <optional>

#include "device_scene.hpp"
#include "engine.hpp"
#include "support/scene_file.hpp"

namespace rays {

/// [bvh]: traversal = "stack", "leaves" or "skip", intersection = "watertight" or "moller", precision = "single" or "double", bins, leaf.
MakeEngine readBvhEngine(const std::optional<examples::SceneTable>& settings);

/// The engine itself, for tests and studies.
std::unique_ptr<Engine> makeBvhEngine(sk::Device& device, const Model& model, const DeviceSettings& settings);

}  // namespace rays
