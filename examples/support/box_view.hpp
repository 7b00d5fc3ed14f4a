// SPDX-License-Identifier: MIT
//
// A parallel projection from above that shows a whole grid in space.
#pragma once

#include <array>
#include <cstdint>

#include <sk/types.hpp>

namespace examples {

struct BoxView {
  sk::float3 middle;        ///< of the grid, in cells, where the centre of the first cell is 0
  sk::float3 right, up;     ///< from the middle of the picture to its edges, in cells
  sk::float3 ahead;         ///< unit vector
  std::int64_t width, height;  ///< pixels
};

/// `cells` along x, y (upwards) and z; `turn` about y and `tilt` downwards are in radians; `width` is the picture's, in pixels.
BoxView boxView(const std::array<std::int64_t, 3>& cells, double turn, double tilt, std::int64_t width);

}  // namespace examples
