// SPDX-License-Identifier: MIT
//
// The results of running one program on one set of data in several modes: for each mode, its relative time
// and its errors. This file only stores results and measures nothing.
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
  double value = 0;  ///< infinity if there is no result
};

/// Results for extreme inputs, whose errors have no meaningful size.
struct ExtremeCounts {
  std::size_t tried = 0;
  std::size_t otherClass = 0;  ///< NaN, infinite, 0 or finite, unlike the reference
  std::size_t otherValue = 0;  ///< of the reference's class, but off by more than 1 %
  Json example = {};  ///< of either kind, as Grade::worst; null if there is none
};

/// The errors of one scalar of a kernel's results.
struct OutputErrors {
  std::string name;
  std::vector<Metric> metrics;
  Json worst;  ///< as Grade::worst
};

/// The errors of a mode.
struct Grade {
  std::vector<Metric> metrics = {};  ///< the first is the relative error, by which modes are compared
  std::optional<double> bound = {};  ///< for the metric that Experiment::bounded names
  bool isWithinBound = true;
  /// For programs that compute each element independently: the inputs of the largest error. For kernels of a
  /// file: "index" and "inputs" (not for reductions), "result" (its name), "got" and "wanted"; if MPFR has checked the
  /// reference, "by_mpfr" and "reference_differs".
  Json worst = {};
  std::vector<OutputErrors> outputs = {};  ///< if there are several
  std::optional<ExtremeCounts> extremes = {};

  double error() const { return metrics.front().value; }
};

/// Times of a mode divided by those of the baseline, for each round.
struct Ratios {
  std::vector<double> rounds = {};
  double lower = 1, median = 1, upper = 1;  ///< quartiles
  double milliseconds = 0;  ///< the median time
};

struct Row {
  std::string mode;
  std::string refused = {};  ///< why the device rejects the mode; if not empty, the rest is unset
  Ratios time = {};
  Grade grade = {};
  bool isPareto = false;  ///< no other mode is both faster and at least as exact, or as fast and more exact

  bool isRefused() const { return !refused.empty(); }
};

struct Experiment {
  std::string program = {};
  std::string data = {};
  std::string about = {};  ///< describes the data: number and condition
  bool isReferenceChecked = false;  ///< by MPFR, at the worst inputs
  std::string bounded = {};  ///< the metric to which bounds apply
  std::vector<Row> rows = {};  ///< the first is the baseline
};

/// Sets isPareto in each row.
void markPareto(std::vector<Row>& rows);

/// The fastest row whose relative error is at most `tolerance`; null if there is none.
const Row* cheapestWithin(const Experiment& experiment, double tolerance);

/// Appends one record per row.
void addRecords(Json& records, const Experiment& experiment);

}  // namespace sk_tool
