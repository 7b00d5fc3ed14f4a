// SPDX-License-Identifier: MIT
//
// Whole files in memory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sk::text {

/// The bytes of a file. Throws sk::Error, "`what` 'FILE' does not exist or cannot be read", as in "the mesh 'a.obj' ...".
std::string bytesOf(const std::filesystem::path& file, std::string_view what);
/// Writes a file, and the folder that it goes to where there is none. Throws sk::Error, "cannot write 'FILE'".
void writeFile(const std::filesystem::path& file, std::string_view bytes);

}  // namespace sk::text
