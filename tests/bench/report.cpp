// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace bench {

Report::Report(std::string device) : device_(std::move(device)) {
  fmt::print("{}\n\n{:<44} {:>9}  {:^17}  {:>9}\n{:-<96}\n", device_, "what", "median", "quartiles", "bar",
             "");
}

void Report::add(Result result) {
  const auto digits = [](double x) { return fmt::format("{:.3g}", x); };
  const std::string verdict = result.bar ? result.passed() ? "ok" : "MISSED" : "";
  fmt::print("{:<44} {:>9}  {:>8} {:>8}  {:>9}  {}\n", result.name,
             digits(result.value.median) + " " + result.unit, digits(result.value.low),
             digits(result.value.high), result.bar ? digits(*result.bar) + " " + result.unit : "", verdict);
  if (!result.note.empty()) fmt::print("    {}\n", result.note);
  std::fflush(stdout);
  results_.push_back(std::move(result));
}

bool Report::allPassed() const {
  return std::all_of(results_.begin(), results_.end(), [](const Result& r) { return r.passed(); });
}

nlohmann::json Report::json() const {
  nlohmann::json rows = nlohmann::json::array();
  for (const Result& r : results_) {
    nlohmann::json row = {{"name", r.name},     {"unit", r.unit},       {"median", r.value.median},
                          {"low", r.value.low}, {"high", r.value.high}, {"passed", r.passed()}};
    if (r.bar) row["bar"] = *r.bar;
    rows.push_back(std::move(row));
  }
  return {{"device", device_}, {"results", std::move(rows)}};
}

}  // namespace bench
