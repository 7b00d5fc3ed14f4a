// SPDX-License-Identifier: MIT
//
// How long skc takes for a file, as a build sees it: process start to process end.
#pragma once

#include <filesystem>
#include <string>

#include "rounds.hpp"

namespace bench {

/// Milliseconds of `skc -o FOLDER FILE`. Throws std::runtime_error where skc cannot be started or fails.
Quartiles compileTime(const std::filesystem::path& skc, const std::filesystem::path& file,
                      const std::filesystem::path& folder, int rounds);

}  // namespace bench
