// SPDX-License-Identifier: MIT
//
// Closed surfaces of solids by marching cubes, in kernels that push triangles (gyroid.sk).
#pragma once

#include <array>
#include <vector>

#include <sk/sk.hpp>

#include "mesh.hpp"

namespace rays {

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
