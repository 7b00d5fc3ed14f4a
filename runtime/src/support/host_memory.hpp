// SPDX-License-Identifier: MIT
//
// The host's memory, as far as the operating system tells.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace sk {

struct HostMemory {
  std::optional<std::int64_t> whole;      ///< bytes; empty if it is unknown
  std::optional<std::int64_t> available;  ///< bytes that programs can take without swapping, likewise
};

/// On Linux, MemTotal and MemAvailable of /proc/meminfo, or less if a control group of this process, as of a container, has a limit
/// (/sys/fs/cgroup, versions 1 and 2): pages of files that it could drop count as available. Elsewhere unknown. `root` is the folder that has
/// proc and sys.
HostMemory hostMemory(const std::filesystem::path& root = "/");

}  // namespace sk
