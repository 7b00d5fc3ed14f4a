// SPDX-License-Identifier: MIT
//
// Shapes in halves: the model is rounded first, so that its hierarchy, its lights and its hits are those of the rounded shapes, and no ray passes between
// triangles that share an edge. Rounding moves a vertex to the same place in all triangles that share it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <sk/types.hpp>

#include "model.hpp"

namespace rays {

enum class VertexStorage : std::uint8_t { Single, Half };

/// Bytes that a shape takes on a device.
constexpr int bytesOfShape(VertexStorage storage) { return storage == VertexStorage::Half ? 32 : 48; }

struct Rounding {
  double farthest =
      0.0;  ///< that a vertex or the surface of a sphere was moved, in lengths of the scene file
  std::int64_t collapsed = 0;  ///< triangles that had an area and have none any more
};

/// Rounds vertices, centres and radii to halves times 2^-14, so that all of the range of halves is used. What would be below their normal numbers, which is less than 2^-28
/// of the model's unit, becomes 0, and of radii 2^-28. Throws std::runtime_error where a length is 4 or more: chooseUnit leaves none above 2.
Rounding roundToHalves(Model& model);

/// What `shapeLayout` (bvh.hpp) has in floats, for a model that is rounded. Three rows a shape: (a, m / 2048), (b, m % 2048), (c, 0), where m is the material;
/// of spheres (centre, m / 2048), (radius, 0, 0, m % 2048), 0. Lengths are multiplied by 2^14.
struct HalfLayout {
  std::vector<sk::half4> rows;
  std::vector<sk::int2> numbers;  ///< one a shape: the id, and the index into Model::triangles; -1: a sphere
};

/// Throws std::runtime_error for more than 2^22 materials.
HalfLayout halfLayout(std::span<const std::uint32_t> order, const Model& model);

}  // namespace rays
