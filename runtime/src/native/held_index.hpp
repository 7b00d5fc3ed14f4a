// SPDX-License-Identifier: MIT
//
// Boundary modes of gathers as the runtime applies them; object code does the same (compiler/native/boundaries.cpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// Stands for the border value in the place of an index.
inline constexpr std::int64_t borderIndex = std::numeric_limits<std::int64_t>::min();

inline std::int64_t modulo(std::int64_t i, std::int64_t period) {
  // saves a division, because few neighbours are farther outside than the extent
  const std::int64_t inside = i < 0 ? i + period : i < period ? i : i - period;
  return inside >= 0 && inside < period ? inside : (i % period + period) % period;
}

/// The index of the element that the gather holds for an index (native::Argument::low); borderIndex if that is the
/// border value.
inline std::int64_t heldIndex(program::Boundary boundary, const native::Argument& gather, std::size_t d,
                              std::int64_t i) {
  const std::int64_t low = gather.low[d], high = gather.high[d], n = gather.extent[d];
  if (i >= low && i < high) return i;
  using program::Boundary;
  switch (boundary) {
    case Boundary::Clamp: break;
    case Boundary::Border:
      if (i < 0 || i >= n) return borderIndex;
      break;
    case Boundary::Wrap: i = low + modulo(i - low, n); break;
    case Boundary::Mirror:
      i = modulo(i, 2 * n);
      if (i >= n) i = 2 * n - 1 - i;
      break;
  }
  return std::max(low, std::min(i, high - 1));
}

}  // namespace sk
