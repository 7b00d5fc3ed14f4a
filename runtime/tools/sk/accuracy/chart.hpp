// SPDX-License-Identifier: MIT
//
// Draws experiments as a chart of time against error, with gnuplot, and places the names of its points so that no name
// overlaps another or a point. The places are pure geometry in pixels, with y upwards.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "accuracy/experiment.hpp"

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

/// Draws one panel per experiment. Throws std::runtime_error if gnuplot is missing or fails.
void drawChart(const std::string& file, const std::string& device,
               const std::vector<Experiment>& experiments);

}  // namespace sk_tool
