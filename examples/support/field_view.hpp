// SPDX-License-Identifier: MIT
//
// How a field of numbers is shown: its colours, the values that they stand for, and a view of grids in space.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <sk/types.hpp>

#include "support/scene_file.hpp"

namespace examples {

struct FieldView {
  std::string colours;  ///< a name that colormap() knows
  std::optional<double> low, high;  ///< values at the ends of the colours; else the field's own
  int zoom = 0;  ///< pixels a cell; 0: as many as make a picture of about a thousand
};

/// Reads colours, low, high and zoom of the table [view].
void readFieldView(const SceneTable& table, FieldView& view);

int zoomFor(const FieldView& view, std::int64_t width, std::int64_t height);

/// The values at the ends of the colours.
struct ShownValues {
  double low = 0.0, high = 1.0;
};
/// For a field from `least` to `most`; of a signed one, 0 is in the middle unless the view says otherwise.
ShownValues shownValues(const FieldView& view, double least, double most, bool isSigned);

/// A parallel projection from above that shows a whole grid in space.
struct BoxView {
  sk::float3 middle;  ///< of the grid, in cells, where the centre of the first cell is 0
  sk::float3 right, up;  ///< from the middle of the picture to its edges, in cells
  sk::float3 ahead;  ///< unit vector
  std::int64_t width, height;  ///< pixels
};

/// `cells` along x, y (upwards) and z; `turn` about y and `tilt` downwards are in radians; `width` is the picture's, in pixels.
BoxView boxView(const std::array<std::int64_t, 3>& cells, double turn, double tilt, std::int64_t width);

}  // namespace examples
