// SPDX-License-Identifier: MIT
#include "accuracy/table.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace sk_tool {

namespace {

std::string boundText(double value) { return std::isinf(value) ? "none" : fmt::format("{:.2g}", value); }

std::string timeOf(const Ratios& time) {
  return fmt::format("{:5.2f} [{:.2f} {:.2f}]", time.median, time.lower, time.upper);
}

/// The width of a metric's column.
std::size_t widthOf(const Metric& metric) { return std::max<std::size_t>(11, metric.name.size() + 2); }

/// Widths of the first columns, which hold the longest names and times of an experiment.
struct Widths {
  std::size_t mode = 17, time = 20;
};

Widths widthsOf(const Experiment& experiment) {
  Widths widths;
  for (const Row& row : experiment.rows) {
    widths.mode = std::max(widths.mode, row.mode.size() + 1);
    if (!row.isRefused()) widths.time = std::max(widths.time, timeOf(row.time).size() + 1);
  }
  return widths;
}

std::string lineOf(const Row& row, const Widths& widths, bool hasBounds) {
  std::string line = fmt::format("  {:<{}}{:<{}}", row.mode, widths.mode, timeOf(row.time), widths.time);
  for (const Metric& metric : row.grade.metrics)
    line += fmt::format("{:>{}}", boundText(metric.value), widthOf(metric));
  if (hasBounds) {
    const char* verdict = !row.grade.bound ? "-" : row.grade.isWithinBound ? "yes" : "NO";
    line += fmt::format("{:>11}  {:<3}", row.grade.bound ? boundText(*row.grade.bound) : "-", verdict);
  }
  if (row.isPareto) line += "  PARETO";
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string headsOf(const Experiment& experiment) {
  const Widths widths = widthsOf(experiment);
  std::string line = fmt::format("  {:<{}}{:<{}}", "mode", widths.mode, " time [quartiles]", widths.time);
  for (const Metric& metric : experiment.rows.front().grade.metrics)
    line += fmt::format("{:>{}}", metric.name, widthOf(metric));
  if (!experiment.bounded.empty()) line += fmt::format("{:>11}  ok", "bound");
  return line + '\n';
}

/// "0.5 (0x1p-1)": as few digits as identify a float or a double, and its bits; integers and what has no digits once.
std::string numberText(const Json& number) {
  const std::string hex = number["hex"].get<std::string>();
  if (number["value"].is_null() || hex.find("0x") == std::string::npos) return hex;
  const double value = number["value"].get<double>();
  return fmt::format(
      "{} ({})",
      number.contains("bits") ? fmt::format("{}", static_cast<float>(value)) : fmt::format("{}", value), hex);
}

/// For example "x = 0.5 (0x1p-1): r is 0 (0x0p+0), not 1 (0x1p+0)"; only a few of many inputs.
std::string caseText(const Json& one) {
  constexpr std::size_t most = 6;
  std::vector<std::string> inputs;
  if (one.contains("inputs")) {
    for (const auto& [name, value] : one["inputs"].items()) {
      const bool isIndex = value.contains("index");
      inputs.push_back(fmt::format("{} {} {}", name, isIndex ? "at" : "=",
                                   isIndex ? value["index"].get<std::string>() : numberText(value)));
    }
  }
  if (inputs.empty() && one.contains("index")) {
    inputs.push_back(fmt::format("element {}", one["index"].get<std::string>()));
  }
  if (inputs.size() > most) {
    inputs.resize(most);
    inputs.emplace_back("...");
  }
  std::string text =
      fmt::format("{}{}{} is {}, not {}", fmt::join(inputs, ", "), inputs.empty() ? "" : ": ",
                  one["result"].get<std::string>(), numberText(one["got"]), numberText(one["wanted"]));
  if (one.value("reference_differs", false))
    text += fmt::format("; but MPFR has {}: the reference is wrong here", numberText(one["by_mpfr"]));
  return text;
}

/// The largest errors of a file's kernels.
std::string worstOf(const Experiment& experiment) {
  std::string text;
  for (const Row& row : experiment.rows) {
    const bool hasWorst = !row.isRefused() && row.grade.worst.contains("result") && row.grade.error() > 0;
    if (hasWorst) text += fmt::format("    {:<18} {}\n", row.mode, caseText(row.grade.worst));
  }
  return text.empty() ? "" : "  the largest error\n" + text;
}

/// The errors of each scalar of the results, if there are several.
std::string outputsOf(const Experiment& experiment) {
  std::string text;
  for (const Row& row : experiment.rows) {
    for (const OutputErrors& output : row.grade.outputs) {
      if (row.isRefused()) continue;
      if (text.empty()) {
        text = fmt::format("  of each result\n    {:<18} {:<18}", "", "");
        for (const Metric& metric : output.metrics)
          text += fmt::format("{:>{}}", metric.name, widthOf(metric));
        text += '\n';
      }
      text += fmt::format("    {:<18} {:<18}", row.mode, output.name);
      for (const Metric& metric : output.metrics)
        text += fmt::format("{:>{}}", boundText(metric.value), widthOf(metric));
      text += '\n';
    }
  }
  return text;
}

std::string extremesOf(const Experiment& experiment) {
  std::string text;
  for (const Row& row : experiment.rows) {
    if (!row.grade.extremes) continue;
    const ExtremeCounts& counts = *row.grade.extremes;
    if (text.empty()) {
      text = fmt::format("  of {} results of extreme inputs\n    {:<18} {:>14}{:>14}\n", counts.tried, "",
                         "another class", "> 1 % off");
    }
    text += fmt::format("    {:<18} {:>14}{:>14}", row.mode, counts.otherClass, counts.otherValue);
    if (!counts.example.is_null()) text += fmt::format("   {}", caseText(counts.example));
    text += '\n';
  }
  return text;
}

std::string verdictOf(const Experiment& experiment, double tolerance) {
  const Row* cheapest = cheapestWithin(experiment, tolerance);
  if (cheapest == nullptr) return fmt::format("  no mode is within {:g}\n", tolerance);
  return fmt::format("  the cheapest within {:g}: {}\n", tolerance, cheapest->mode);
}

}  // namespace

std::string tableOf(const Experiment& experiment, bool hasHeads, std::optional<double> tolerance) {
  std::string text = fmt::format("{}, {}: {}\n", experiment.program, experiment.data, experiment.about);
  if (hasHeads) text += headsOf(experiment);
  const Widths widths = widthsOf(experiment);
  for (const Row& row : experiment.rows) {
    text += row.isRefused() ? fmt::format("  {:<{}}refused: {}", row.mode, widths.mode, row.refused)
                            : lineOf(row, widths, !experiment.bounded.empty());
    text += '\n';
  }
  text += outputsOf(experiment) + worstOf(experiment) + extremesOf(experiment);
  if (tolerance) text += verdictOf(experiment, *tolerance);
  return text + '\n';
}

}  // namespace sk_tool
