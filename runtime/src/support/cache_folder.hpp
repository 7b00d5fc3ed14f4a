// SPDX-License-Identifier: MIT
//
// Small files that outlive the process: measurements of drivers, and program binaries. The folder is SK_CACHE
// ("off": nothing is kept), else $XDG_CACHE_HOME/streamkernel, else ~/.cache/streamkernel. Nothing here ever
// fails: what cannot be kept is measured again.
//
// Only the user's own files are used, in a folder to which nobody else may write; in a folder that several
// users may write to, each user has a subfolder. A file begins with its key and a checksum of the rest.
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
  /// The environment is read only here, because other threads may change it later.
  CacheFolder();
  explicit CacheFolder(std::filesystem::path folder, std::uintmax_t mostBytes = defaultBytes)
      : path_(std::move(folder)), mostBytes_(mostBytes) {}

  /// Empty if nothing is kept.
  const std::filesystem::path& path() const { return path_; }

  /// The text stored under a name and key; nullopt if there is none, if its key differs, or if it cannot be
  /// trusted.
  std::optional<std::string> read(std::string_view name, std::string_view key) const noexcept;

  /// Stores a text under a name; `key` says what the text depends on. Readers see the complete text or none,
  /// even while other processes write it. If all files together are too large, the least recently used ones
  /// are deleted. Thread-safe.
  void write(std::string_view name, std::string_view key, std::string_view text) const noexcept;

  /// Returns the stored positive number; otherwise calls `measure` and stores its result if it is positive.
  double measuredOnce(std::string_view name, std::string_view key,
                      const std::function<double()>& measure) const;

 private:
  static constexpr std::uintmax_t defaultBytes = std::uintmax_t{64} << 20;

  std::filesystem::path path_;
  std::uintmax_t mostBytes_ = defaultBytes;
  mutable std::atomic<std::uintmax_t> unchecked_ =
      defaultBytes;  ///< bytes written since the files were last counted
};

/// FNV-1a: for file names and for detecting corrupted files.
std::uint64_t hashOf(std::string_view text);

/// Identifies what every measurement depends on: the driver and the version of StreamKernel.
std::string driverKey(std::string_view renderer, std::string_view driver, std::string_view profile);

/// Identifies the processor and its number of threads, on which measurements of software depend.
std::string processorKey();

}  // namespace sk
