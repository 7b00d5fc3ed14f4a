// SPDX-License-Identifier: MIT
//
// Times for people.
#pragma once

#include <string>

#include <fmt/format.h>

namespace sk_tool {

/// Seconds with three digits in the unit that suits them.
inline std::string secondsText(double seconds) {
  if (seconds == 0) return "0";
  if (seconds < 1e-6) return fmt::format("{:.3g} ns", seconds * 1e9);
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  return seconds < 1 ? fmt::format("{:.3g} ms", seconds * 1e3) : fmt::format("{:.3g} s", seconds);
}

}  // namespace sk_tool
