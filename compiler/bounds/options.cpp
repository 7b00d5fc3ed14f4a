// SPDX-License-Identifier: MIT
#include "bounds/options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace skc::bounds {
namespace {

double number(std::string_view text, std::string_view whole) {
  double value = 0;
  const char* const first = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw std::invalid_argument(fmt::format("'{}' in '{}' is not a finite number", text, whole));
  return value;
}

}  // namespace

NamedRange parseRange(std::string_view text) {
  const std::size_t equal = text.find('=');
  if (equal == std::string_view::npos || equal == 0)
    throw std::invalid_argument(fmt::format("'{}' is not a range; write NAME=LOW:HIGH", text));
  const std::string_view ends = text.substr(equal + 1);
  const std::size_t colon = ends.find(':');
  NamedRange range{std::string(text.substr(0, equal)), 0, 0};
  range.low = number(ends.substr(0, colon), text);
  range.high = colon == std::string_view::npos ? range.low : number(ends.substr(colon + 1), text);
  if (!(range.low <= range.high))
    throw std::invalid_argument(fmt::format("'{}' ends before it begins; write the lower end first", text));
  return range;
}

std::optional<Interval> rangeOf(const Options& options, const ir::KernelParam& param, std::string_view name) {
  for (std::string_view part = name; !part.empty();) {
    // The last of several counts, as of other options.
    for (auto it = options.ranges.rbegin(); it != options.ranges.rend(); ++it) {
      if (it->name == part) return Interval{it->low, it->high};
    }
    const std::size_t cut = part.find_last_of(".[");
    if (cut == std::string_view::npos) break;
    part = part.substr(0, cut);
  }
  // A declared range bounds the parameter, not its index or extent. A stream rounds the ends as it rounds its elements.
  const bool isOfValue = name.substr(0, name.find_first_of(".[")) == param.name;
  if (!isOfValue || !param.range || !std::isfinite(param.range->low) || !std::isfinite(param.range->high))
    return std::nullopt;
  const double low = param.range->low, high = param.range->high;
  return Interval{std::min<double>(low, static_cast<float>(low)),
                  std::max<double>(high, static_cast<float>(high))};
}

}  // namespace skc::bounds
