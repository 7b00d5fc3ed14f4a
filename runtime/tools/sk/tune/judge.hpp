// SPDX-License-Identifier: MIT
//
// How exact results are: compares what a run read with the truth, result by result, and says whether its decisions are those of
// the program as it is.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "results/results_file.hpp"

namespace sk_tool::tune {

enum class Metric : std::uint8_t {
  Relative,  ///< the largest of |x - t| / |t|
  Absolute,  ///< the largest of |x - t|
  Ulp,  ///< the largest of |x - t| in units of the last place of the float t
  L2,  ///< the root of the sum of (x - t)^2 over that of t^2
  Psnr,  ///< the root of the mean of (x - t)^2 over the range of t, which is 1 in pictures; printed in dB
};

/// Throws std::runtime_error with all names unless there is one like this.
Metric metricOf(const std::string& name);
std::string_view nameOf(Metric metric);

/// A result that counts.
struct Wanted {
  std::string name;
  Metric metric = Metric::L2;
  double tolerance = 0;  ///< of the metric; for Psnr: dB
  bool isPicture = false;
};

/// Parses NAME[=METRIC[:TOLERANCE]]. Throws std::runtime_error.
Wanted parseWanted(const std::string& text, Metric metric, double tolerance);

/// The error of one read. Infinite where one of both is no number, or another infinity than the other.
double errorOf(const sk::results::Values& values, const sk::results::Values& truth, Metric metric,
               bool isPicture);

struct ResultError {
  std::string name;
  Metric metric;
  double error = 0;  ///< of the worst of its reads; for Psnr: dB
  double overTolerance = 0;  ///< at most 1 if it is exact enough
  /// The error of rounding the right results to floats, divided by the tolerance: no choice has less. 0 if no floats are read.
  double ofRounding = 0;
};

struct Verdict {
  std::vector<ResultError> errors;
  double score = 0;  ///< the largest of overTolerance
  std::string decision = {};  ///< the first decision that is not the program's own; empty if all are

  bool isExact() const { return score <= 1; }
  /// The error furthest from its tolerance; null if no result is of floats.
  const ResultError* worst() const;
};

class Judge {
 public:
  /// `base` is a run of the program as it is. The reads of `ignored` never count. Throws std::runtime_error if a wanted name
  /// does not exist; an empty list stands for all reads.
  Judge(const sk::results::Process& base, const sk::results::Process& truth, std::vector<Wanted> wanted,
        Metric metric, double tolerance, std::span<const std::string> ignored);

  Verdict judge(const sk::results::Process& run) const;
  const std::vector<Wanted>& wanted() const { return wanted_; }

 private:
  const sk::results::Process& base_;
  const sk::results::Process& truth_;
  std::vector<Wanted> wanted_;
  std::vector<double> ofRounding_;  ///< for each wanted one
};

/// Null if a run has no reads of this name.
const sk::results::Series* seriesNamed(const sk::results::Process& process, std::string_view name);
/// The names of reads that differ between two runs of the same program.
std::vector<std::string> differences(const sk::results::Process& a, const sk::results::Process& b);

}  // namespace sk_tool::tune
