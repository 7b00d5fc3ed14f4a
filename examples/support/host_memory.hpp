// SPDX-License-Identifier: MIT
//
// Whether the host has the memory for what a file or an option asks for, before it is read or allocated. Linux gives memory that it has not, and ends the process later.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace examples {

/// Bytes that the process can still take: limits of control groups and SK_MEMORY_LIMIT count. nullopt where nobody tells.
std::optional<std::int64_t> availableMemory();

/// Throws std::runtime_error, "WHAT takes about N bytes of memory, and M are available", if it is known to be more than there is.
void requireMemory(std::string_view what, double bytes);

}  // namespace examples
