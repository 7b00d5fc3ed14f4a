// SPDX-License-Identifier: MIT
#include "check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace race {

std::optional<std::string> faultOf(const std::vector<float>& result, const Check& check) {
  const bool isWhole = check.places.empty();
  if (isWhole && result.size() != check.values.size()) {
    return fmt::format("gives {} numbers, not {}", result.size(), check.values.size());
  }
  double largest = 0;
  for (const double value : check.values) largest = std::max(largest, std::fabs(value));
  std::size_t count = 0;
  std::string first;
  for (std::size_t i = 0; i < check.values.size(); ++i) {
    const std::size_t place = isWhole ? i : static_cast<std::size_t>(check.places[i]);
    if (place >= result.size()) return fmt::format("gives {} numbers only", result.size());
    if (std::fabs(result[place] - check.values[i]) <= check.tolerance * largest) continue;
    if (count++ == 0) first = fmt::format("number {} is {}, not {}", place, result[place], check.values[i]);
  }
  if (static_cast<double>(count) <= check.exempt * static_cast<double>(check.values.size())) return {};
  return fmt::format("{} ({} of {} that were looked at are wrong)", first, count, check.values.size());
}

}  // namespace race
