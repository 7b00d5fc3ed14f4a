// SPDX-License-Identifier: MIT
//
// Pictures through a uniform grid.
#pragma once

#include <memory>

#include "engine.hpp"
#include "grid_scene.hpp"
#include "grid_tracer.hpp"

namespace rays {

/// The scene and the tracer must outlive it.
std::unique_ptr<Renderer> makeStreamingRenderer(GridScene& scene, GridTracer& tracer, const Picture& picture,
                                                const StreamingSettings& settings);

}  // namespace rays
