// SPDX-License-Identifier: MIT
//
// What `./dev exhaustive` found (exhaustive.json): the errors of functions of one float over all arguments, or every k-th.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace numerics {

struct ExhaustiveCase {
  float x;
  double error;  ///< in ulp
};

struct ExhaustiveRun {
  std::string function, profile;
  std::uint64_t arguments;
  double largest;  ///< error in ulp
  std::vector<ExhaustiveCase> worst;
};

inline std::vector<ExhaustiveRun> exhaustiveRuns() {
  std::vector<ExhaustiveRun> runs;
  for (const auto& record : nlohmann::json::parse(std::ifstream(SK_EXHAUSTIVE_RUNS))) {
    ExhaustiveRun run{record["function"], record["profile"], record["arguments"], record["largest"], {}};
    for (const auto& one : record["worst"])
      run.worst.push_back({std::stof(one["x"].get<std::string>()), one["error"]});
    runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace numerics
