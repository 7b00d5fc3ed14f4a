// SPDX-License-Identifier: MIT
//
// Whether the host has the memory for what a file or an option asks for, before it is read or allocated. Linux gives memory that it has not, and ends the process later.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <sk/sk.hpp>

#include "text/memory.hpp"

namespace examples {

using sk::text::requireMemory;

/// Bytes that the process can still take: limits of control groups and SK_MEMORY_LIMIT count. nullopt where nobody tells.
std::optional<std::int64_t> availableMemory();

/// What a run on a grid takes for each cell, in bytes: on the device, and on the host beside it.
struct BytesPerCell {
  double device = 0.0, host = 0.0;
};

/// Throws std::runtime_error, "SIZE cells take about N GB of memory, and M GB are available; take at most K cells, with --size", if the run is known to take more than the
/// device or the host has. Devices that compute on the host have its memory. The cells on the device are divided over `ranks`.
void requireMemoryForGrid(const sk::Device& device, std::string_view size, std::int64_t cells,
                          const BytesPerCell& need, int ranks = 1);

}  // namespace examples
