// SPDX-License-Identifier: MIT
//
// Overlap tests of boxes in double precision, for structures that list the shapes in their cells.
#pragma once

#include <array>

#include "model.hpp"

namespace rays {

using Corner = std::array<double, 3>;

inline Corner cornerOf(const sk::float3& v) { return {v.x, v.y, v.z}; }

/// Returns true if a triangle meets a box: none of the separating axes separates them (T. Akenine-Möller, "Fast 3D triangle-box overlap
/// testing", 2001).
bool meets(const std::array<Corner, 3>& triangle, const Corner& centre, const Corner& half);

/// Returns true if a sphere's surface meets a box. The radius is widened by 2^-20 to both sides: see boundsOf in bvh.hpp.
bool meets(const Corner& middle, double radius, const Corner& centre, const Corner& half);

}  // namespace rays
