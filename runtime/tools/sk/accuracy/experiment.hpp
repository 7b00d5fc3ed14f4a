// SPDX-License-Identifier: MIT
//
// The results of running one program on one set of data in several modes: for each mode, its relative time
// and its errors. This file only stores results and measures nothing.
//
// Runs the modes of a program alternately, A B C A B C ..., so that a busy machine affects all modes equally.
// Times are wall-clock times around Device::finish(), because GL's own timers are wrong on llvmpipe.
//
// Errors of kernels that compute each element independently.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sk/device.hpp"

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
  std::vector<Metric> metrics = {};  ///< the first is a relative error, by which modes are compared
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

/// A mode that is ready to run.
struct Trial {
  std::function<void()> run;  ///< the timed part
  std::function<Grade()> grade;  ///< of the results of the first run
};

struct Mode {
  std::string name;
  std::function<Trial()> prepare;  ///< throws sk::Error if the device rejects the mode, as `run` may
};

/// Returns one row per mode. The first mode is the baseline, which every device supports: its sk::Error is
/// not caught.
std::vector<Row> compareModes(sk::Device& device, const std::vector<Mode>& modes, int rounds);

/// A named input stream, for reporting the element with the largest error.
struct NamedInput {
  std::string name;
  const std::vector<float>* values;
};

/// Computes the largest relative error, the largest and the mean error in ulp, and how many results are
/// infinite or NaN where the reference is not, or vice versa ("wrong class": these make the relative error
/// infinite and are in no other figure); also the inputs of the largest error, with their bits. References
/// below the smallest normal float count as that number in relative errors.
Grade gradeElements(const std::vector<float>& results, const std::vector<double>& reference,
                    const std::vector<NamedInput>& inputs);

}  // namespace sk_tool
