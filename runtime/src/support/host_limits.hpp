// SPDX-License-Identifier: MIT
//
// What this process may use of its machine: processors and memory, as the operating system and control groups (those of a
// container, for example) limit them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sk {

/// The folders of the control groups that limit this process, its own first and then those around it. A controller's name, such as
/// "memory" or "cpu", asks for the first version of control groups, and "" for the second. Files are read below `root`. In a
/// container, the path may not exist, and its own group is the outermost one.
std::vector<std::string> controlGroups(const std::filesystem::path& root, std::string_view controller);

/// How many threads this process may run at once: the processors that it may use, less what quotas of control groups and other
/// ranks of an MPI program on this machine take. At least 1. Files are read below `root`; tests have their own.
int availableProcessors(const std::filesystem::path& root = "/");

/// Processors of a quota of control groups, rounded down, but at least 1; `processors` where there is no quota below it.
int withinQuota(int processors, const std::filesystem::path& root);

/// A rank's share of a machine with `online` processors, of which it may use `usable` and on which `ranks` ranks run.
int shareOfRank(int usable, int online, int ranks);

/// Bytes of the cache of this level, 1 to 3, that a processor has or shares with others; 0 if it is unknown.
std::int64_t bytesOfCache(int level);

struct HostMemory {
  std::optional<std::int64_t> whole;  ///< bytes; empty if it is unknown
  std::optional<std::int64_t> available;  ///< bytes that programs can take without swapping, likewise
};

/// On Linux, MemTotal and MemAvailable of /proc/meminfo, or less if a control group of this process, as of a container, has a limit
/// (/sys/fs/cgroup, versions 1 and 2): pages of files that it could drop count as available. Elsewhere unknown. `root` is the folder that has
/// proc and sys.
HostMemory hostMemory(const std::filesystem::path& root = "/");

}  // namespace sk
