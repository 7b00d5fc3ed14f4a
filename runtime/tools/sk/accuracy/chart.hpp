// SPDX-License-Identifier: MIT
//
// Experiments as a chart, time against error, drawn by gnuplot.
#pragma once

#include <string>
#include <vector>

#include "accuracy/experiment.hpp"

namespace sk_tool {

/// Throws std::runtime_error unless the file's name ends in .svg or .png.
void checkChartName(const std::string& file);

/// One panel an experiment. Throws std::runtime_error where there is no gnuplot, or it fails.
void drawChart(const std::string& file, const std::string& device,
               const std::vector<Experiment>& experiments);

}  // namespace sk_tool
