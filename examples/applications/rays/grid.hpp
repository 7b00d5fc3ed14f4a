// SPDX-License-Identifier: MIT
//
// A uniform grid over triangles and spheres, built on the host, as lists for devices (T. Purcell, I. Buck, W. Mark, P. Hanrahan, "Ray
// tracing on programmable graphics hardware", 2002). It knows no device.
#pragma once

#include <cstdint>
#include <vector>

#include <sk/types.hpp>

#include "bvh.hpp"
#include "model.hpp"

namespace rays {

/// Cells along an axis: kernels keep the three numbers of a cell in one int.
inline constexpr int mostCells = 512;

struct GridSettings {
  double density = 4.0;  ///< cells for each shape
};

struct UniformGrid {
  Bounds bounds;
  sk::float3 cell{};  ///< extents of one
  sk::int3 size{};  ///< cells along each axis; 0 where there are no shapes
  std::vector<int> starts;  ///< for each cell, x fastest: where its list begins in `lists`; -1: it is empty
  std::vector<int> lists;  ///< numbers of shapes, triangles before spheres; each list ends with -1
  int longest = 0;  ///< shapes of the longest list
  std::int64_t entries = 0;  ///< shapes of all lists
  std::int64_t occupied = 0;  ///< cells that are not empty
};

/// A cell lists every shape that comes within `margin` of it. Rounding moves a ray by less while the ray begins within 300 extents of
/// the scene, so that its hits are always listed in a cell that it passes.
double gridMargin(const Bounds& bounds);

/// Builds a grid with as many cells as the settings ask for, or fewer if the lists would have more than 2^26 entries.
UniformGrid buildGrid(const Model& model, const GridSettings& settings);

}  // namespace rays
