// SPDX-License-Identifier: MIT
//
// How long skc takes for a file, and how long skc and the C++ compiler take together, as a build sees it: from process start to
// process end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rounds.hpp"

namespace bench {

/// Milliseconds of `skc -o FOLDER FILE`. Throws std::runtime_error where skc cannot be started or fails.
Quartiles compileTime(const std::filesystem::path& skc, const std::filesystem::path& file,
                      const std::filesystem::path& folder, int rounds);

/// Milliseconds of the same and `COMPILER... FOLDER/FILE.cpp`: from an edit of a .sk file to objects. `compiler` is the program and
/// its options. Throws std::runtime_error where one of the two cannot be started or fails.
Quartiles editTime(const std::filesystem::path& skc, const std::vector<std::string>& compiler,
                   const std::filesystem::path& file, const std::filesystem::path& folder, int rounds);

}  // namespace bench
