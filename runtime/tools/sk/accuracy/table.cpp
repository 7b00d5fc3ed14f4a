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

std::string lineOf(const Row& row, bool hasBounds) {
  std::string line = fmt::format("  {:<17}{:<20}", row.mode, timeOf(row.time));
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
  std::string line = fmt::format("  {:<17}{:<20}", "mode", " time [quartiles]");
  for (const Metric& metric : experiment.rows.front().grade.metrics)
    line += fmt::format("{:>{}}", metric.name, widthOf(metric));
  if (!experiment.bounded.empty()) line += fmt::format("{:>11}  ok", "bound");
  return line + '\n';
}

/// For example "x = 0x1p-12, y = 0x1p+0: r is 0x0p+0, not 0x1p-1"; only a few of many inputs.
std::string caseText(const Json& one) {
  constexpr std::size_t most = 6;
  std::vector<std::string> inputs;
  if (one.contains("inputs")) {
    for (const auto& [name, value] : one["inputs"].items()) {
      const bool isIndex = value.contains("index");
      inputs.push_back(fmt::format("{} {} {}", name, isIndex ? "at" : "=",
                                   value[isIndex ? "index" : "hex"].get<std::string>()));
    }
  }
  if (inputs.empty() && one.contains("index")) {
    inputs.push_back(fmt::format("element {}", one["index"].get<std::string>()));
  }
  if (inputs.size() > most) {
    inputs.resize(most);
    inputs.emplace_back("...");
  }
  return fmt::format("{}{}{} is {}, not {}", fmt::join(inputs, ", "), inputs.empty() ? "" : ": ",
                     one["result"].get<std::string>(), one["got"]["hex"].get<std::string>(),
                     one["wanted"]["hex"].get<std::string>());
}

/// The largest errors of a file's kernels.
std::string worstOf(const Experiment& experiment) {
  std::string text;
  for (const Row& row : experiment.rows) {
    const bool hasWorst = !row.isRefused() && row.grade.worst.contains("result") && row.grade.error() > 0;
    if (hasWorst) text += fmt::format("    {:<17}{}\n", row.mode, caseText(row.grade.worst));
  }
  return text.empty() ? "" : "  the largest error\n" + text;
}

std::string extremesOf(const Experiment& experiment) {
  std::string text;
  for (const Row& row : experiment.rows) {
    if (!row.grade.extremes) continue;
    const ExtremeCounts& counts = *row.grade.extremes;
    if (text.empty()) {
      text = fmt::format("  of {} results of extreme inputs\n    {:<17}{:>14}{:>14}\n", counts.tried, "",
                         "another class", "> 1 % off");
    }
    text += fmt::format("    {:<17}{:>14}{:>14}", row.mode, counts.otherClass, counts.otherValue);
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
  for (const Row& row : experiment.rows) {
    text += row.isRefused() ? fmt::format("  {:<17}refused: {}", row.mode, row.refused)
                            : lineOf(row, !experiment.bounded.empty());
    text += '\n';
  }
  text += worstOf(experiment) + extremesOf(experiment);
  if (tolerance) text += verdictOf(experiment, *tolerance);
  return text + '\n';
}

}  // namespace sk_tool
