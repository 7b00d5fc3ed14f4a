// SPDX-License-Identifier: MIT
//
// The table that sk_bench prints line by line, and the same as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "rounds.hpp"

namespace bench {

/// One line. The value's quartiles and the bar have the unit's dimension; smaller is better.
struct Result {
  std::string name;
  std::string unit;
  Quartiles value;
  std::optional<double> bar;
  std::string note;
  bool passed() const { return !bar || value.median <= *bar; }
};

class Report {
 public:
  /// Prints the heads of the columns.
  explicit Report(std::string device);

  /// Prints and keeps a line.
  void add(Result result);
  bool allPassed() const;
  nlohmann::json json() const;

 private:
  std::string device_;
  std::vector<Result> results_;
};

}  // namespace bench
