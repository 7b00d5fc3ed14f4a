// SPDX-License-Identifier: MIT
//
// Small files that outlive the process, in which what was measured of a driver is kept: in the folder that SK_CACHE
// names ("off": nowhere), else in $XDG_CACHE_HOME/streamkernel, else in ~/.cache/streamkernel. Nothing here ever
// fails: what cannot be kept is measured again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace sk {

/// Empty: nothing is kept.
std::filesystem::path cacheFolder();

/// What was kept under a name for a key; none where nothing was, or for another key, or cannot be read.
std::optional<std::string> readCached(std::string_view name, std::string_view key);

/// Keeps a text under a name for a key: `key` says what the text depends on, in words. Readers see all of it or
/// nothing, also while other processes write the same.
void writeCached(std::string_view name, std::string_view key, std::string_view text) noexcept;

/// What everything that is measured depends on: the words of a driver and the version of StreamKernel.
std::string driverKey(std::string_view renderer, std::string_view driver, std::string_view profile);

}  // namespace sk
