// SPDX-License-Identifier: MIT
//
// Small files that outlive the process, in which what was measured of a driver and the programs that it has made are kept: in the folder that SK_CACHE
// names ("off": nowhere), else in $XDG_CACHE_HOME/streamkernel, else in ~/.cache/streamkernel. Nothing here ever
// fails: what cannot be kept is measured again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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

/// What is kept as a number above 0, else what `measure` finds, which is kept if it is one.
double measuredOnce(std::string_view name, std::string_view key, const std::function<double()>& measure);

/// Deletes files of a name, the longest unused first, until those that stay take three quarters of `bytes` or less; none where they
/// take no more than `bytes`.
void boundCached(std::string_view name, std::uintmax_t bytes) noexcept;

/// FNV-1a: for the names of files, and to tell whether a file is what it was.
std::uint64_t hashOf(std::string_view text);

/// What everything that is measured depends on: the words of a driver and the version of StreamKernel.
std::string driverKey(std::string_view renderer, std::string_view driver, std::string_view profile);

}  // namespace sk
