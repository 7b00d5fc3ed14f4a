// SPDX-License-Identifier: MIT
//
// Checks real numbers on command lines. CLI11's own checks take NaN, and print limits with hundreds of digits.
#pragma once

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <fmt/format.h>

namespace sk_tool {

/// Nullopt if the text is not one finite number. What is too small for a double is 0.
inline std::optional<double> finiteNumberIn(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(number)) return std::nullopt;
  return number;
}

inline CLI::Validator aboveZero() {
  const auto check = [](const std::string& text) -> std::string {
    const std::optional<double> number = finiteNumberIn(text);
    if (number && *number > 0) return {};
    return fmt::format("'{}' is no number above 0; give one such as 1e-5", text);
  };
  return {check, "ABOVE 0"};
}

inline CLI::Validator realIn(double least, double most) {
  const auto check = [=](const std::string& text) -> std::string {
    const std::optional<double> number = finiteNumberIn(text);
    if (number && *number >= least && *number <= most) return {};
    return fmt::format("'{}' is no number from {:g} to {:g}", text, least, most);
  };
  return {check, fmt::format("{:g} TO {:g}", least, most)};
}

inline CLI::Validator zeroOrAbove() {
  const auto check = [](const std::string& text) -> std::string {
    const std::optional<double> number = finiteNumberIn(text);
    if (number && *number >= 0) return {};
    return fmt::format("'{}' is no number from 0 on", text);
  };
  return {check, "0 OR ABOVE"};
}

}  // namespace sk_tool
