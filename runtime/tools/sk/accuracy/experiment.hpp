// SPDX-License-Identifier: MIT
//
// What comes of running one program on one set of data in several modes: for each mode its time as a ratio and its
// errors. Results only; nothing is measured here.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace sk_tool {

using Json = nlohmann::ordered_json;

struct Metric {
  std::string name;
  double value = 0;  ///< infinity where there is no result at all
};

/// Results of extreme inputs, whose errors have no size.
struct ExtremeCounts {
  std::size_t tried = 0;
  std::size_t otherClass = 0;  ///< NaN, infinite, 0 or finite where the reference is another of these
  std::size_t otherValue = 0;  ///< of the same class, but off by more than 1 %
  Json example = {};  ///< of either, as Grade::worst; null where there are none
};

/// How wrong the results of a mode are.
struct Grade {
  std::vector<Metric> metrics = {};  ///< the first is the relative error, by which modes are compared
  std::optional<double> bound = {};  ///< of the metric that Experiment::bounded names
  bool isWithinBound = true;
  /// Of programs that compute element by element: the inputs of the largest error. Of the kernels of a file: "index" and
  /// "inputs" (not of reduces), "result" (its name), "got" and "wanted".
  Json worst = {};
  std::optional<ExtremeCounts> extremes = {};

  double error() const { return metrics.front().value; }
};

/// Times of a mode over those of the baseline, round by round.
struct Ratios {
  std::vector<double> rounds = {};
  double lower = 1, median = 1, upper = 1;  ///< quartiles
  double milliseconds = 0;  ///< the median time itself
};

struct Row {
  std::string mode;
  std::string refused = {};  ///< why the device does not run the mode; then nothing else is known
  Ratios time = {};
  Grade grade = {};
  bool isPareto = false;  ///< no other mode is both faster and as exact, or as fast and more exact

  bool isRefused() const { return !refused.empty(); }
};

struct Experiment {
  std::string program = {};
  std::string data = {};
  std::string about = {};  ///< of the data: how many, how hard
  std::string bounded = {};  ///< the metric that bounds are of
  std::vector<Row> rows = {};  ///< the first is the baseline
};

/// Says of each row whether it isPareto.
void markPareto(std::vector<Row>& rows);

/// The row with the least time whose relative error is `tolerance` at most; null where there is none.
const Row* cheapestWithin(const Experiment& experiment, double tolerance);

/// One record a row.
void addRecords(Json& records, const Experiment& experiment);

}  // namespace sk_tool
