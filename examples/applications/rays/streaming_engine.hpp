// SPDX-License-Identifier: MIT
//
// The streaming ray tracer (T. Purcell, I. Buck, W. Mark, P. Hanrahan, "Ray tracing on programmable graphics hardware", 2002): everything on the
// device, over a uniform grid.
#pragma once

#include <optional>

#include "engine.hpp"
#include "grid_tracer.hpp"
#include "support/scene_file.hpp"

namespace rays {

/// [streaming]: machine = "branching" or "multipass", use = "paths", "whitted", "shadows" or "rays", intersection = "watertight" or "moller", density, tests, rounds, compact.
MakeEngine readStreamingEngine(const std::optional<examples::SceneTable>& settings);

std::unique_ptr<Engine> makeStreamingEngine(sk::Device& device, const Model& model,
                                            const StreamingSettings& settings);

}  // namespace rays
