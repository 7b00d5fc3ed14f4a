// SPDX-License-Identifier: MIT
//
// Surfaces of triangles on the host: their files, generators, measures, faults and pictures. Nothing here knows a device.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "support/image.hpp"
#include "support/vec.hpp"

namespace smooth {

using examples::Vector;
using Triangle = std::array<std::int32_t, 3>;

struct Surface {
  std::vector<Vector> points;
  std::vector<Triangle> faces;  ///< counterclockwise from outside; indices are below the number of points
};

/// What a flow must treat apart. Numbers count from 0, in ascending order.
struct Faults {
  std::vector<std::int64_t>
      degenerate;  ///< faces whose area is at most 1e-12 times the square of their longest edge
  std::vector<std::pair<std::int32_t, std::int32_t>> nonManifold;  ///< edges of three faces or more
  std::vector<std::int32_t> isolated;  ///< points that belong to no face, or to degenerate ones only
  std::vector<bool> boundary;  ///< of each point: whether one of its edges has a single face
  bool isClosed = true;
};

Faults inspect(const Surface& surface);
/// Inspects anew what depends on positions, degenerate faces and isolated points; edges stay what they are while points move.
void inspectAreas(const Surface& surface, Faults& faults);
/// A line for each kind of fault, with its first numbers, which count from 1 as in OBJ files; "" if there is none.
std::string textOf(const Faults& faults);

/// The signed volume that a closed surface encloses.
double volumeOf(const Surface& surface);
double areaOf(const Surface& surface);
Vector centreOf(const Surface& surface);

/// An icosahedron whose faces were divided into four `level` times, on a sphere around the origin.
Surface sphere(int level, double radius);
/// `around` times `across` quadrilaterals, the axis along y.
Surface torus(int around, int across, double radius, double tube);
/// Moves every point by up to `amplitude` in each direction; the same seed gives the same surface everywhere.
void addNoise(Surface& surface, double amplitude, std::uint32_t seed);

/// Positions and faces of an OBJ file; polygons are cut into triangles. Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong".
Surface loadObj(const std::filesystem::path& file);
/// Positions have as many digits as it takes to read the same doubles again.
void saveObj(const std::filesystem::path& file, const Surface& surface);

/// A shaded picture, drawn by a depth buffer: seen from the front and above, as large as `frame` fills a picture of size x size; one brightness for each face, so that noise is seen.
examples::Image pictureOf(const Surface& surface, const Surface& frame, int size);

}  // namespace smooth
