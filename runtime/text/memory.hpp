// SPDX-License-Identifier: MIT
//
// Whether the host has the memory for what a file or an option asks for, before it is read or allocated. Linux gives memory that it has not, and ends the process later.
#pragma once

#include <string_view>

namespace sk::text {

/// Throws sk::Error, "WHAT takes about N GB of memory, and M GB are available", if it is known to be more than there is. Limits of control groups and SK_MEMORY_LIMIT
/// count.
void requireMemory(std::string_view what, double bytes);

}  // namespace sk::text
