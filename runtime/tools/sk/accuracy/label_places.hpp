// SPDX-License-Identifier: MIT
//
// Places the names of points in a chart, so that no name overlaps another or a point. Pure geometry in
// pixels, with y upwards; it draws nothing.
#pragma once

#include <span>
#include <vector>

namespace sk_tool {

struct LabelledPoint {
  double x = 0, y = 0;
  double textWidth = 0;
};

/// The middle of a text's left edge, and whether a line must connect the text to its point.
struct LabelPlace {
  double x = 0, y = 0;
  bool isApart = false;
};

inline constexpr double labelHeight = 14;

/// Returns one place per point, inside a chart of that size if there is room: as near as the previous labels
/// allow.
std::vector<LabelPlace> placeLabels(std::span<const LabelledPoint> points, double width, double height);

}  // namespace sk_tool
