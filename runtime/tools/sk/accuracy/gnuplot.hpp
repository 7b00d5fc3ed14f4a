// SPDX-License-Identifier: MIT
//
// Runs gnuplot, for every command that draws a chart.
#pragma once

#include <string>

namespace sk_tool {

/// Throws std::runtime_error unless the file's name ends in .svg or .png.
void checkChartName(const std::string& file);

/// Quotes as gnuplot does.
std::string quoted(const std::string& text);

/// The commands that choose the file and its format, with the size in pixels.
std::string terminalOf(const std::string& file, double width, double height);

/// Runs a script that draws to `file`. Throws std::runtime_error if the file cannot be written, or if gnuplot is missing or
/// fails.
void runGnuplot(const std::string& file, const std::string& script);

}  // namespace sk_tool
