// SPDX-License-Identifier: MIT
//
// Small files that outlive the process, in which what was measured of a driver and the programs that it has made are kept:
// in the folder that SK_CACHE names ("off": nowhere), else in $XDG_CACHE_HOME/streamkernel, else in
// ~/.cache/streamkernel. Nothing here ever fails: what cannot be kept is measured again.
//
// Only files of the user's own count, in a folder where nobody else may write; in a folder that several users may write
// to, each has a folder of their own. A file begins with its key and a checksum of the rest.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace sk {

class CacheFolder {
 public:
  /// The environment is read here and never again, since other threads may change it.
  CacheFolder();
  explicit CacheFolder(std::filesystem::path folder, std::uintmax_t mostBytes = defaultBytes)
      : path_(std::move(folder)), mostBytes_(mostBytes) {}

  /// Empty: nothing is kept.
  const std::filesystem::path& path() const { return path_; }

  /// What was kept under a name for a key; none where nothing was, or for another key, or what there is cannot be trusted.
  std::optional<std::string> read(std::string_view name, std::string_view key) const noexcept;

  /// Keeps a text under a name for a key: `key` says what the text depends on, in words. Readers see all of it or
  /// nothing, also while other processes write the same. Where all files together have too many bytes, those that have not
  /// been used for longest are deleted. Threads may call this at the same time.
  void write(std::string_view name, std::string_view key, std::string_view text) const noexcept;

  /// What is kept as a number above 0, else what `measure` finds, which is kept if it is one.
  double measuredOnce(std::string_view name, std::string_view key,
                      const std::function<double()>& measure) const;

 private:
  static constexpr std::uintmax_t defaultBytes = std::uintmax_t{64} << 20;

  std::filesystem::path path_;
  std::uintmax_t mostBytes_ = defaultBytes;
  mutable std::atomic<std::uintmax_t> unchecked_ =
      defaultBytes;  ///< bytes written since all files were counted
};

/// FNV-1a: for the names of files, and to tell whether a file is what it was.
std::uint64_t hashOf(std::string_view text);

/// What everything that is measured depends on: the words of a driver and the version of StreamKernel.
std::string driverKey(std::string_view renderer, std::string_view driver, std::string_view profile);

/// The processor in words, and how many threads it runs: what is measured of software depends on it.
std::string processorKey();

}  // namespace sk
