// SPDX-License-Identifier: MIT
//
// Boundary modes of gathers and samples, as functions of an index and an extent.
#pragma once

#include <algorithm>
#include <cstdint>

namespace run_tests {

/// What the tests' [[border]] gives outside.
inline constexpr int outsideValue = -7;

/// Maps any index into the extent, as a boundary mode does; -1 stands for the border.
inline std::int64_t clampIndex(std::int64_t i, std::int64_t n) {
  return std::clamp<std::int64_t>(i, 0, n - 1);
}
inline std::int64_t wrapIndex(std::int64_t i, std::int64_t n) { return ((i % n) + n) % n; }
inline std::int64_t mirrorIndex(std::int64_t i, std::int64_t n) {
  const std::int64_t m = wrapIndex(i, 2 * n);
  return m < n ? m : 2 * n - 1 - m;
}
inline std::int64_t borderIndex(std::int64_t i, std::int64_t n) { return i < 0 || i >= n ? -1 : i; }
using Inside = std::int64_t (*)(std::int64_t, std::int64_t);

}  // namespace run_tests
