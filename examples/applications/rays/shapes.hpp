// SPDX-License-Identifier: MIT
//
// Meshes and spheres that are computed, closed ones all but the quad and the terrain.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <sk/sk.hpp>

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

/// The teapot of M. Newell ("The utilization of procedure models in digital image synthesis", 1975): 32 bicubic patches of level x level cells
/// each. It stands on y = 0 about the y axis, and is 1 wide from the handle to the tip of the spout. With normals; it is open where the lid lies and where the
/// spout ends.
Mesh teapot(int level);

// Closed surfaces of solids by marching cubes, in kernels that push triangles (gyroid.sk).

/// The triangles of a cell, three edges each, then -1, for each set of its corners that are inside: bit i is the corner whose x, y and z are bits 0, 1
/// and 2 of i. Edge 4 a + s + 2 t goes along axis a from the corner with s along axis a + 1 and t along axis a + 2, modulo 3. Seen from outside, corners go
/// counterclockwise. Faces of a cell keep corners that are inside apart where there are two ways, so that cells on both sides fit.
using CubeTable = std::array<std::array<int, 32>, 256>;
const CubeTable& cubeTable();

/// The triangles between points where a field of points x points x points is below 0 and where it is not, x fastest. Three edges each: the number of an
/// edge is 3 times that of the point where it begins, plus its axis. Where the field's border is not below 0, each two triangles share an edge.
std::vector<sk::int3> surfaceOf(sk::Device& device, const sk::Stream<float>& field);

/// A closed wall along the gyroid sin x cos y + sin y cos z + sin z cos x = 0, with normals, cut to a ball of diameter 0.96. The cube from -1/2 to
/// 1/2 has `cells` cells along each side and `turns` periods of the surface; the wall is where the function's magnitude is below `thickness`.
Mesh gyroid(sk::Device& device, int cells, double turns, double thickness);

}  // namespace rays
