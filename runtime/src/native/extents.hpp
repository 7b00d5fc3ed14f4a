// SPDX-License-Identifier: MIT
//
// Shapes as native code has them, with x first, and how an input's extents fit a domain's.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "native/call.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

/// Extents with x first; missing dimensions have extent 1.
inline native::Extents fastestFirst(const Shape& shape) {
  native::Extents extents{1, 1, 1, 1};
  for (int d = 0; d < shape.rank(); ++d) {
    extents[static_cast<std::size_t>(shape.rank() - 1 - d)] = shape[d];
  }
  return extents;
}

/// Sets how the index in an element input follows from that in the domain.
inline void fit(native::Operand& operand, program::Fit way, const native::Extents& domain) {
  for (std::size_t d = 0; d < domain.size(); ++d) {
    const std::int64_t extent = operand.extent[d];
    if (way == program::Fit::Same) {
      operand.multiply[d] = extent == 1 ? 0 : 1;
    } else {  // one of the two is 1
      operand.divide[d] = std::max<std::int64_t>(domain[d] / extent, 1);
      operand.multiply[d] = std::max<std::int64_t>(extent / domain[d], 1);
    }
  }
}

}  // namespace sk
