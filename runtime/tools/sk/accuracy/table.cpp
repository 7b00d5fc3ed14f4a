// SPDX-License-Identifier: MIT
#include "accuracy/table.hpp"

#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace sk_tool {

namespace {

std::string numberOf(double value) { return std::isinf(value) ? "none" : fmt::format("{:.2g}", value); }

std::string timeOf(const Ratios& time) {
  return fmt::format("{:5.2f} [{:.2f} {:.2f}]", time.median, time.lower, time.upper);
}

std::string lineOf(const Row& row) {
  std::string line = fmt::format("  {:<17}{:<20}", row.mode, timeOf(row.time));
  const auto add = [&line](const std::string& cell) {
    fmt::format_to(std::back_inserter(line), "{:>11}", cell);
  };
  for (const Metric& metric : row.grade.metrics) add(numberOf(metric.value));
  add(row.grade.bound ? numberOf(*row.grade.bound) : "-");
  const char* verdict = !row.grade.bound ? "-" : row.grade.isWithinBound ? "yes" : "NO";
  line += fmt::format("  {:<3}  {}", verdict, row.isPareto ? "PARETO" : "");
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string headsOf(const Experiment& experiment) {
  std::string line = fmt::format("  {:<17}{:<20}", "mode", " time [quartiles]");
  for (const Metric& metric : experiment.rows.front().grade.metrics)
    line += fmt::format("{:>11}", metric.name);
  return line + fmt::format("{:>11}  ok\n", "bound");
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
    text += row.isRefused() ? fmt::format("  {:<17}refused: {}", row.mode, row.refused) : lineOf(row);
    text += '\n';
  }
  if (tolerance) text += verdictOf(experiment, *tolerance);
  return text + '\n';
}

}  // namespace sk_tool
