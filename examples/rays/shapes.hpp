// SPDX-License-Identifier: MIT
//
// Meshes and spheres that are computed, closed ones all but the quad and the terrain.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh.hpp"

namespace rays {

/// The square from -1/2 to 1/2 in x and z at y = 0, seen from above.
Mesh quad();
/// The cube from -1/2 to 1/2.
Mesh box();
/// Menger's sponge of this level (0 is the cube); only faces that are seen, 12 * 20^level triangles at most.
Mesh sponge(int level);
/// A sphere of radius 1/2 from an icosahedron whose triangles are quartered `level` times; with its normals if smooth.
Mesh icosphere(int level, bool smooth);
/// A torus about the y axis with this radius of the tube; the whole is 1 wide.
Mesh torus(int around, int across, double tube);
/// Fractal terrain by displaced midpoints (Fournier, Fussell, Carpenter 1982): 2^level squares a side, from -1/2 to 1/2, rising
/// to `height` or so.
Mesh terrain(int level, double height, std::uint32_t seed);

/// A sphere with nine smaller ones on it, and so on (E. Haines, "A proposal for standard graphics environments", 1987): the sum of 9^k
/// for k up to `level`.
std::vector<Sphere> sphereFlake(Vector centre, double radius, int level);

}  // namespace rays
