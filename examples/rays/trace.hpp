// SPDX-License-Identifier: MIT
//
// Hits in the lengths of the scene file, whatever engine finds them and whatever rays are given.
#pragma once

#include <span>
#include <vector>

#include "engine.hpp"
#include "model.hpp"

namespace rays {

/// The nearest hits of rays that have the lengths of the scene file, and directions of any length. Denormal directions count as
/// they are.
std::vector<Hit> traceRays(Engine& engine, const Model& model, std::span<const Ray> rays);

/// Hits of engines as those of the scene file: `t` in its lengths. For rays of unit length in the model's units.
void toSceneLengths(const Model& model, std::span<Hit> hits);

}  // namespace rays
