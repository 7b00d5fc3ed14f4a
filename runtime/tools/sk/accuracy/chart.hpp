// SPDX-License-Identifier: MIT
//
// Draws experiments as a chart of time against error, with gnuplot.
#pragma once

#include <string>
#include <vector>

#include "accuracy/experiment.hpp"

namespace sk_tool {

/// Draws one panel per experiment. Throws std::runtime_error if gnuplot is missing or fails.
void drawChart(const std::string& file, const std::string& device,
               const std::vector<Experiment>& experiments);

}  // namespace sk_tool
