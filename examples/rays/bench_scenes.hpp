// SPDX-License-Identifier: MIT
//
// Generated scenes that tracers are compared on: a furnished hall, seen from inside, and a closed mesh as grown things have it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model.hpp"

namespace rays {

/// Vases, rings and blocks between walls, where every ray hits something: 301,000 triangles, or few.
Model interior(bool isSmall);

/// A torus with bumps and folds: 70,000 triangles, or few.
Model organic(bool isSmall);

/// Rays from what `rays` hit, in any direction about the normal, with the density of the cosine. They are in the order of `rays`, which is gone
/// through again until there are `count`. Throws std::logic_error if nothing is hit.
std::vector<Ray> diffuseRays(const Model& model, std::span<const Ray> rays, std::span<const Hit> hits,
                             std::size_t count);

}  // namespace rays
