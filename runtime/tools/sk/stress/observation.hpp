// SPDX-License-Identifier: MIT
//
// What the shadow's report (docs/json.md) says of one run of a program, in short.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shadow/entry.hpp"

namespace sk_tool::stress {

struct Range {
  double low, high;
  bool operator==(const Range&) const = default;
};

/// What the host gives a parameter: a value, or a stream that it has written.
struct Given {
  std::string kernel, parameter;
  std::string
      scalar;  ///< of its numbers: "float", "double", "half", "unorm", "snorm", "int", "uint" or "bool"
  bool isStream = false;
  double low = 0, high = 0;  ///< of all numbers that the program as it is gives
  std::optional<Range> range = {};  ///< that [[range]] declares
  std::int64_t elements = 1;
};

struct Result {
  std::string name;
  std::int64_t elements = 0;
  std::int64_t withoutValue = 0;  ///< NaN or infinite
  double error = 0;  ///< relative, the largest of all reads
};

struct Calls {
  std::string kernel;
  std::int64_t calls = 0;
};

/// Where the first NaN or infinity comes from.
struct Origin {
  bool isNan = false;
  std::string kernel, output;
  std::int64_t call = 0;
  bool isInReference = false;  ///< double gives none, or one, too
};

struct LoopEnd {
  std::string condition;
  std::int64_t unfinished = 0, longest = 0;
};

struct Observation {
  std::string device;
  bool hasEnded = false;
  std::int64_t calls = 0;
  std::vector<Given> given;
  std::vector<Result> results;
  std::vector<Calls> kernels;
  std::vector<LoopEnd> loops;
  std::optional<Origin> origin;
  std::string unstable;  ///< the verdict on an unstable step; empty if there is none

  /// The largest relative error of the results.
  const Result* worst() const;
  const Result* resultNamed(const std::string& name) const;
};

/// Throws std::runtime_error, which names the place, if the report lacks something.
Observation observationIn(const Entry& report);

}  // namespace sk_tool::stress
