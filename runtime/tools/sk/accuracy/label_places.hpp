// SPDX-License-Identifier: MIT
//
// Where the names of points go in a chart, so that none covers another or a point. Geometry in pixels, y upwards; the chart
// draws.
#pragma once

#include <span>
#include <vector>

namespace sk_tool {

struct LabelledPoint {
  double x = 0, y = 0;
  double textWidth = 0;
};

/// The middle of a text's left edge, and whether it is apart from its point, so that a line must join them.
struct LabelPlace {
  double x = 0, y = 0;
  bool isApart = false;
};

inline constexpr double labelHeight = 14;

/// One place a point, inside a chart of that size wherever there is room: as near as those of the points before leave.
std::vector<LabelPlace> placeLabels(std::span<const LabelledPoint> points, double width, double height);

}  // namespace sk_tool
