// SPDX-License-Identifier: MIT
#include "support/extents.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

namespace examples {
namespace {

/// The value of at most five digits, else -1.
std::int64_t valueOf(std::string_view digits) {
  std::int64_t value = -1;
  if (digits.size() > 5 || digits.find_first_not_of("0123456789") != std::string_view::npos) return -1;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

}  // namespace

std::vector<std::int64_t> extentsOf(std::string_view option, std::string_view text,
                                    const ExtentLimits& limits) {
  std::vector<std::int64_t> extents;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('x', at), text.size());
    extents.push_back(valueOf(text.substr(at, end - at)));
    at = end + 1;
  }
  const auto isAllowed = [&](std::int64_t n) { return n >= limits.least && n <= limits.most; };
  if (extents.size() < 2 || std::ssize(extents) > limits.mostCount ||
      !std::ranges::all_of(extents, isAllowed))
    throw std::runtime_error(fmt::format("{}: '{}' is no size; write WxH{}, each from {} to {}", option, text,
                                         limits.mostCount > 2 ? " or WxHxD" : "", limits.least, limits.most));
  return extents;
}

}  // namespace examples
