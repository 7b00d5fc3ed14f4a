// SPDX-License-Identifier: MIT
//
// Polygons as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "support/vec.hpp"

namespace examples {

/// Cuts a polygon of n corners into n - 2 triangles, which have its orientation and together its area: a fan from the first corner where
/// that is inside, or else ears (G. Meisters, "Polygons have ears", 1975). A polygon that is not flat is seen along its mean normal (M.
/// Newell's). Corners may be in one line or in one position; a polygon that crosses itself or has no area gets n - 2 triangles, too.
/// Replaces `triangles`, whose numbers count the corners from 0.
void triangulate(std::span<const Vector> corners, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace examples
