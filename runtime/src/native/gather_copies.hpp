// SPDX-License-Identifier: MIT
//
// What copies of gathers for one call have in common (padded_rows.hpp, column_panels.hpp).
#pragma once

#include <cstdint>

#include "native/call.hpp"

namespace sk {

/// The number of rows of a gather, in all dimensions but x.
inline std::int64_t rowsOf(const native::Operand& from) {
  return from.extent[1] * from.extent[2] * from.extent[3];
}

/// The number of the first element of a row.
inline std::int64_t firstOfRow(const native::Operand& from, std::int64_t row) {
  const std::int64_t y = row % from.extent[1];
  const std::int64_t z = row / from.extent[1] % from.extent[2];
  const std::int64_t w = row / from.extent[1] / from.extent[2];
  return from.first + y * from.stride[1] + z * from.stride[2] + w * from.stride[3];
}

/// True if copying `columns` of each row takes little time beside the call: many blocks of `rows` rows read the gather, and
/// the copy is not much larger than what is computed.
inline bool paysToCopy(const native::Operand& from, std::int64_t columns, const native::Extents& computed,
                       std::int64_t rows) {
  constexpr std::int64_t fewestBlocks = 16;
  constexpr std::int64_t mostPerElement = 4;
  const std::int64_t elements = computed[0] * computed[1] * computed[2] * computed[3];
  return computed[1] >= fewestBlocks * rows && columns * rowsOf(from) <= mostPerElement * elements;
}

}  // namespace sk
