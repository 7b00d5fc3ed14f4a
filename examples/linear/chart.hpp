// SPDX-License-Identifier: MIT
//
// Charts of residuals over iterations, with a logarithmic scale: for the terminal, and as SVG.
#pragma once

#include <span>
#include <string>

#include "solve.hpp"

namespace linear {

/// Lines of text, each ended; "" if there are fewer than two points.
std::string textChart(std::span<const HistoryPoint> history, double tolerance);
/// A whole SVG document.
std::string svgChart(std::span<const HistoryPoint> history, double tolerance, const std::string& title);

}  // namespace linear
