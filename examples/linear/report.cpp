// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace linear {

std::string textOf(const Account& account, const Solution& solution) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "layout {}", account.layout);
  if (!account.offsetBits.empty()) fmt::format_to(out, ", offsets of {} bits", account.offsetBits);
  if (account.stored > 0) fmt::format_to(out, ", {} entries stored for {}", account.stored, account.entries);
  for (std::size_t i = 0; i < account.costs.size(); ++i)
    fmt::format_to(out, "{}{} {:.3g} KB", i == 0 ? "; estimated cost of a product: " : ", ",
                   account.costs[i].layout, account.costs[i].bytes / 1000.0);
  if (account.hierarchy) {
    std::string sizes;
    for (const HierarchyAccount::Level& level : account.hierarchy->levels)
      sizes += fmt::format("{}{}", sizes.empty() ? "" : ", ", level.unknowns);
    fmt::format_to(out, "\nlevels of {} unknowns, operator complexity {:.3g}, set up in {:.3g} ms", sizes,
                   account.hierarchy->operatorComplexity(), account.hierarchy->seconds * 1000.0);
  }
  fmt::format_to(out, "\n{} after {} iterations", nameOf(solution.outcome), solution.iterations);
  if (solution.restarts > 0)
    fmt::format_to(out, ", begun anew {} times for the residual in double precision", solution.restarts);
  fmt::format_to(
      out, "\nresidual {:.3g} (known to {:.1g}; {:.3g} as the method computed it), backward error {:.3g}\n",
      solution.residualTrue, solution.residualError, solution.residualRecurred, solution.backwardError);
  if (solution.removedMean != 0.0)
    fmt::format_to(out, "the right-hand side's mean {:.6g} was removed, for no x reaches a constant\n",
                   solution.removedMean);
  return text;
}

std::string jsonOf(const Account& account, const Solution& solution) {
  nlohmann::ordered_json json;
  json["outcome"] = nameOf(solution.outcome);
  json["iterations"] = solution.iterations;
  json["restarts"] = solution.restarts;
  json["residual_true"] = solution.residualTrue;
  json["residual_error"] = solution.residualError;
  json["residual_recurred"] = solution.residualRecurred;
  json["backward_error"] = solution.backwardError;
  json["removed_mean"] = solution.removedMean;
  json["seconds"] = solution.seconds;
  json["layout"] = account.layout;
  if (!account.offsetBits.empty()) json["offset_bits"] = account.offsetBits;
  json["fill"] = account.fill();
  json["device"] = account.device;
  const double iterations = static_cast<double>(std::max<std::int64_t>(1, solution.iterations));
  json["rates"]["per_iteration"] = std::pow(solution.residualTrue, 1.0 / iterations);
  json["rates"]["levels"] = nlohmann::ordered_json::array();
  for (const LevelRate& level : account.rates) {
    nlohmann::ordered_json row;
    for (int d = level.grid.rank() - 1; d >= 0; --d) row["grid"].push_back(level.grid[d]);
    row["rate"] = level.rate;
    json["rates"]["levels"].push_back(row);
  }
  if (account.hierarchy) {
    auto& hierarchy = json["hierarchy"];
    hierarchy["levels"] = nlohmann::ordered_json::array();
    for (const HierarchyAccount::Level& level : account.hierarchy->levels)
      hierarchy["levels"].push_back(
          {{"unknowns", level.unknowns}, {"entries", level.entries}, {"layout", level.layout}});
    hierarchy["operator_complexity"] = account.hierarchy->operatorComplexity();
    hierarchy["setup_seconds"] = account.hierarchy->seconds;
  }
  return json.dump(2) + "\n";
}

}  // namespace linear
