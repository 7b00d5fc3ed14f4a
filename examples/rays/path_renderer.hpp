// SPDX-License-Identifier: MIT
//
// Path tracing by one kernel.
#pragma once

#include <memory>

#include "device_scene.hpp"
#include "engine.hpp"

namespace rays {

/// `scene` must outlive it.
std::unique_ptr<Renderer> makePathRenderer(DeviceScene& scene, const Picture& picture);

}  // namespace rays
