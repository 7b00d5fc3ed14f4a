// SPDX-License-Identifier: MIT
#include "support/host_memory.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace sk {

namespace {

namespace fs = std::filesystem;

/// The number after a key at the beginning of a line.
std::optional<std::int64_t> numberAfter(const fs::path& file, std::string_view key) {
  std::ifstream in(file);
  std::string word, rest;
  while (in >> word) {
    std::int64_t number = 0;
    if (word == key) return in >> number ? std::optional(number) : std::nullopt;
    std::getline(in, rest);
  }
  return std::nullopt;
}

/// The number that is all of a file; nullopt for "max".
std::optional<std::int64_t> numberIn(const fs::path& file) {
  std::ifstream in(file);
  std::int64_t number = 0;
  return in >> number ? std::optional(number) : std::nullopt;
}

/// How a version of control groups says what a group may use, and uses.
struct GroupFiles {
  std::string_view folder, most, used, droppable;
};
constexpr GroupFiles version1{"sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                              "total_inactive_file"};
constexpr GroupFiles version2{"sys/fs/cgroup", "memory.max", "memory.current", "inactive_file"};

/// The control groups of this process: in version 2 the path in the line "0::PATH", and in version 1 that of the list of controllers with "memory".
std::string groupOf(const fs::path& file, bool isVersion2) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos || line.size() <= second + 1) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    const bool isOwn =
        isVersion2 ? line.starts_with("0::/") : controllers.find(",memory,") != std::string::npos;
    if (isOwn) return line.substr(second + 2);
  }
  return {};
}

void limit(std::optional<std::int64_t>& bytes, std::int64_t most) {
  bytes = std::max<std::int64_t>(0, std::min(bytes.value_or(most), most));
}

/// A group is also limited by all groups around it. A container may see its own group as the outermost one, whatever path it is told.
void limitByGroups(HostMemory& memory, const fs::path& root, const std::string& innermost,
                   const GroupFiles& files) {
  for (fs::path group = innermost;; group = group.parent_path()) {
    const fs::path folder = root / files.folder / group;
    if (const auto most = numberIn(folder / files.most)) {
      limit(memory.whole, *most);
      const std::int64_t used = numberIn(folder / files.used).value_or(0) -
                                numberAfter(folder / "memory.stat", files.droppable).value_or(0);
      limit(memory.available, *most - used);
    }
    if (group.empty() || !group.has_relative_path()) return;
  }
}

}  // namespace

HostMemory hostMemory(const fs::path& root) {
  constexpr std::int64_t kibibyte = 1024;
  HostMemory memory;
  if (const auto whole = numberAfter(root / "proc/meminfo", "MemTotal:")) memory.whole = kibibyte * *whole;
  if (const auto free = numberAfter(root / "proc/meminfo", "MemAvailable:"))
    memory.available = kibibyte * *free;
  const fs::path groups = root / "proc/self/cgroup";
  limitByGroups(memory, root, groupOf(groups, true), version2);
  limitByGroups(memory, root, groupOf(groups, false), version1);
  return memory;
}

}  // namespace sk
