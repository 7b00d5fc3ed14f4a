// SPDX-License-Identifier: MIT
//
// A whole file in memory.
#pragma once

#include <filesystem>
#include <string>

namespace examples {

/// Throws std::runtime_error naming the file where it is missing, cannot be read or is empty.
std::string readBytes(const std::filesystem::path& file);

}  // namespace examples
