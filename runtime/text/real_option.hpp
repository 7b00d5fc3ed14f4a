// SPDX-License-Identifier: MIT
//
// Checks real numbers on command lines, for the option's check(). CLI11's own ranges take NaN, and print limits with up to hundreds of
// digits. Must not know CLI11.
#pragma once

#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace sk::text {

/// Nullopt if the text is not one finite number. What is too small for a double is 0.
inline std::optional<double> finiteNumberIn(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// A check that returns what is wrong with a number's text; "" if nothing is.
inline auto realFrom(double least, double most) {
  return [=](const std::string& text) -> std::string {
    const std::optional<double> number = finiteNumberIn(text);
    if (number && *number >= least && *number <= most) return {};
    return fmt::format("'{}' is no number from {:g} to {:g}", text, least, most);
  };
}

inline auto aboveZero() {
  return [](const std::string& text) -> std::string {
    const std::optional<double> number = finiteNumberIn(text);
    if (number && *number > 0) return {};
    return fmt::format("'{}' is no number above 0; give one such as 1e-5", text);
  };
}

inline auto zeroOrAbove() {
  return [](const std::string& text) -> std::string {
    const std::optional<double> number = finiteNumberIn(text);
    if (number && *number >= 0) return {};
    return fmt::format("'{}' is no number from 0 on", text);
  };
}

}  // namespace sk::text
