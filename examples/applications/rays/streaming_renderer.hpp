// SPDX-License-Identifier: MIT
//
// Pictures by either machine: one kernel that follows a path through a uniform grid, or many calls around whatever traces rays.
#pragma once

#include <memory>

#include "engine.hpp"
#include "grid_tracer.hpp"
#include "pass_meter.hpp"
#include "ray_streams.hpp"

namespace rays {

/// What they are given must outlive renderers.
std::unique_ptr<Renderer> makeBranchingRenderer(GridScene& scene, const Picture& picture, Use use);
std::unique_ptr<Renderer> makeMultipassRenderer(const DeviceShapes& shapes, StreamTracer& tracer,
                                                const Picture& picture, Use use, PassMeter* meter = nullptr);

}  // namespace rays
