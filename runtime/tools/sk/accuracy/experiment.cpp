// SPDX-License-Identifier: MIT
#include "accuracy/experiment.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "info/numbers.hpp"
#include "quantile.hpp"
#include "sk/error.hpp"

namespace sk_tool {

namespace {

bool dominates(const Row& a, const Row& b) {
  const bool isNoWorse = a.time.median <= b.time.median && a.grade.error() <= b.grade.error();
  return isNoWorse && (a.time.median < b.time.median || a.grade.error() < b.grade.error());
}

/// A number, or null if it is not finite, because JSON has no infinity.
Json numberOf(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json recordOf(const Experiment& experiment, const Row& row) {
  Json record = {{"program", experiment.program}, {"data", experiment.data}, {"mode", row.mode}};
  if (row.isRefused()) {
    record["refused"] = row.refused;
    return record;
  }
  record["baseline"] = experiment.rows.front().mode;
  record["time"] = {{"ratio", row.time.median},
                    {"lower_quartile", row.time.lower},
                    {"upper_quartile", row.time.upper},
                    {"milliseconds", row.time.milliseconds},
                    {"ratios", row.time.rounds}};
  for (const Metric& metric : row.grade.metrics) record["metrics"][metric.name] = numberOf(metric.value);
  for (const OutputErrors& output : row.grade.outputs) {
    Json& one = record["outputs"][output.name];
    for (const Metric& metric : output.metrics) one["metrics"][metric.name] = numberOf(metric.value);
    one["worst"] = output.worst;
  }
  if (row.grade.bound) {
    record["bound"] = numberOf(*row.grade.bound);
    record["bounded"] = experiment.bounded;
  }
  record["within_bound"] = row.grade.isWithinBound;
  record["pareto"] = row.isPareto;
  if (!row.grade.worst.is_null()) record["worst"] = row.grade.worst;
  if (const auto& extremes = row.grade.extremes) {
    record["extremes"] = {{"tried", extremes->tried},
                          {"other_class", extremes->otherClass},
                          {"other_value", extremes->otherValue}};
    if (!extremes->example.is_null()) record["extremes"]["example"] = extremes->example;
  }
  return record;
}

}  // namespace

void markPareto(std::vector<Row>& rows) {
  for (Row& row : rows) {
    row.isPareto = !row.isRefused() && std::isfinite(row.grade.error()) &&
                   std::none_of(rows.begin(), rows.end(), [&](const Row& other) {
                     return !other.isRefused() && dominates(other, row);
                   });
  }
}

const Row* cheapestWithin(const Experiment& experiment, double tolerance) {
  const Row* cheapest = nullptr;
  for (const Row& row : experiment.rows) {
    if (row.isRefused() || !(row.grade.error() <= tolerance)) continue;
    if (cheapest == nullptr || row.time.median < cheapest->time.median) cheapest = &row;
  }
  return cheapest;
}

void addRecords(Json& records, const Experiment& experiment) {
  for (const Row& row : experiment.rows) records.push_back(recordOf(experiment, row));
}

namespace {

double secondsOf(sk::Device& device, const std::function<void()>& work) {
  using Clock = std::chrono::steady_clock;
  device.finish();
  const Clock::time_point start = Clock::now();
  work();
  device.finish();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Ratios ratiosOf(const std::vector<double>& seconds, const std::vector<double>& baseline) {
  Ratios ratios;
  for (std::size_t i = 0; i < seconds.size(); ++i) ratios.rounds.push_back(seconds[i] / baseline[i]);
  std::vector<double> sorted = ratios.rounds;
  std::sort(sorted.begin(), sorted.end());
  ratios.lower = quantile(sorted, 0.25);
  ratios.median = quantile(sorted, 0.5);
  ratios.upper = quantile(sorted, 0.75);
  ratios.milliseconds = 1e3 * median(seconds);
  return ratios;
}

}  // namespace

std::vector<Row> compareModes(sk::Device& device, const std::vector<Mode>& modes, int rounds) {
  std::vector<Row> rows;
  std::vector<std::optional<Trial>> trials;
  for (const Mode& mode : modes) {
    Row row{.mode = mode.name};
    std::optional<Trial> trial;
    try {
      trial = mode.prepare();
      trial->run();  // compiles, so that compilation is not timed
      row.grade = trial->grade();
    } catch (const sk::Error& error) {
      if (rows.empty()) throw;
      row.refused = error.what();
      trial.reset();
    }
    rows.push_back(std::move(row));
    trials.push_back(std::move(trial));
  }
  std::vector<std::vector<double>> seconds(modes.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (trials[i]) seconds[i].push_back(secondsOf(device, trials[i]->run));
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (trials[i]) rows[i].time = ratiosOf(seconds[i], seconds.front());
  }
  markPareto(rows);
  return rows;
}

namespace {

Json inputsAt(const std::vector<NamedInput>& inputs, std::size_t at) {
  Json json;
  for (const NamedInput& input : inputs) {
    const float value = (*input.values)[at];
    json[input.name] = {{"value", value},
                        {"bits", fmt::format("0x{:08x}", std::bit_cast<std::uint32_t>(value))}};
  }
  return json;
}

/// The reference, or infinity if it is out of the range of floats.
double inRangeOfFloats(double reference) {
  constexpr double largest = std::numeric_limits<float>::max();
  return std::fabs(reference) > largest ? std::copysign(HUGE_VAL, reference) : reference;
}

}  // namespace

Grade gradeElements(const std::vector<float>& results, const std::vector<double>& reference,
                    const std::vector<NamedInput>& inputs) {
  constexpr double smallest = std::numeric_limits<float>::min();
  double relative = 0, largest = -1, sum = 0, wrongClass = 0;
  std::size_t worst = 0, numbers = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double exact = inRangeOfFloats(reference[i]);
    if (!std::isfinite(exact) || !std::isfinite(results[i])) {
      const bool isRight = std::isnan(exact) ? std::isnan(results[i]) : exact == results[i];
      if (!isRight && ++wrongClass == 1) worst = i;
      continue;
    }
    const double error = std::fabs(results[i] - exact);
    relative = std::max(relative, error / std::max(std::fabs(exact), smallest));
    const double ulps = error / ulpOf(exact);
    sum += ulps;
    ++numbers;
    if (ulps > largest) {
      largest = ulps;
      if (wrongClass == 0) worst = i;
    }
  }
  if (wrongClass > 0) relative = HUGE_VAL;
  return {.metrics = {{"rel err", relative},
                      {"max ulp", numbers == 0 && wrongClass > 0 ? HUGE_VAL : std::max(largest, 0.0)},
                      {"mean ulp", numbers > 0      ? sum / static_cast<double>(numbers)
                                   : wrongClass > 0 ? HUGE_VAL
                                                    : 0},
                      {"wrong class", wrongClass}},
          .worst = inputsAt(inputs, worst)};
}

}  // namespace sk_tool
