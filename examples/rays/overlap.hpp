// SPDX-License-Identifier: MIT
//
// What meets a box, in double precision: for structures that list what lies in their cells.
#pragma once

#include <array>

#include "model.hpp"

namespace rays {

using Corner = std::array<double, 3>;

inline Corner cornerOf(const sk::float3& v) { return {v.x, v.y, v.z}; }

/// Whether a triangle meets a box: no axis of those that count separates them (T. Akenine-Möller, "Fast 3D triangle-box overlap
/// testing", 2001).
bool meets(const std::array<Corner, 3>& triangle, const Corner& centre, const Corner& half);

/// Whether a sphere's surface meets a box. Its radius counts as 2^-20 larger and smaller: see boundsOf in bvh.hpp.
bool meets(const Corner& middle, double radius, const Corner& centre, const Corner& half);

}  // namespace rays
