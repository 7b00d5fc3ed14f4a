// SPDX-License-Identifier: MIT
#include "accuracy/compare_modes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "quantile.hpp"
#include "sk/error.hpp"

namespace sk_tool {

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

}  // namespace sk_tool
