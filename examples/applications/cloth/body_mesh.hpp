// SPDX-License-Identifier: MIT
//
// Triangles of boxes with rounded edges. A sphere is a box that is nothing but rounding, and a capsule one that is long in one
// direction, so that one mesh draws all bodies.
#pragma once

#include <cstdint>
#include <vector>

#include <sk/types.hpp>

#include "scene.hpp"

namespace examples {

struct Mesh {
  std::vector<sk::float3> positions;  ///< around the body's own place
  std::vector<sk::float3> normals;
  std::vector<std::uint32_t> triangles;  ///< three indices each, counter-clockwise from outside
};

/// A box of these half extents with edges rounded by `radius`, which is at most the least of them.
Mesh roundedBox(Vector half, double radius);

/// A body at the origin, turned as it is. Of a plane nothing: it is drawn as the ground.
Mesh meshOf(const Body& body);

}  // namespace examples
