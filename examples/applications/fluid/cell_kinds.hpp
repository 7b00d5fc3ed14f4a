// SPDX-License-Identifier: MIT
//
// What cells of a grid are. Kernels and the host both include this file, which therefore has nothing else in it.
#pragma once

namespace fluid {

/// Around a dimension that is not periodic lies one layer of cells that are no fluid.
enum Cell {
  Solid,  ///< a wall, or an inflow: velocities at its faces are given, and the fluid sticks to it
  Fluid,
  Outflow,  ///< pressure 0 at its faces
  Slip,  ///< a wall without friction
};

/// Where cells may be something else than fluid.
enum Bounds {
  Nowhere,  ///< all dimensions are periodic
  Around,  ///< in the layer around the grid only, which follows from an index
  Anywhere,  ///< where a stream of cells says so
};

}  // namespace fluid
