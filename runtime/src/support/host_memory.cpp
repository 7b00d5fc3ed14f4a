// SPDX-License-Identifier: MIT
#include "support/host_memory.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

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

/// The control group of this process: the path in the line "0::PATH".
std::string groupOf(const fs::path& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("0::/")) return line.substr(4);
  return {};
}

void limit(std::optional<std::int64_t>& bytes, std::int64_t most) {
  bytes = std::max<std::int64_t>(0, std::min(bytes.value_or(most), most));
}

/// A group is also limited by all groups around it.
void limitByGroups(HostMemory& memory, const fs::path& root) {
  const fs::path all = root / "sys/fs/cgroup";
  for (fs::path group = groupOf(root / "proc/self/cgroup");; group = group.parent_path()) {
    const fs::path folder = all / group;
    if (const auto most = numberIn(folder / "memory.max")) {
      limit(memory.whole, *most);
      const std::int64_t used = numberIn(folder / "memory.current").value_or(0) -
                                numberAfter(folder / "memory.stat", "inactive_file").value_or(0);
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
  limitByGroups(memory, root);
  return memory;
}

}  // namespace sk
