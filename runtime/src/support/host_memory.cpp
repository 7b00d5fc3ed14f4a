// SPDX-License-Identifier: MIT
#include "support/host_memory.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

#include "support/control_groups.hpp"

namespace sk {

namespace {

namespace fs = std::filesystem;

/// The number after a key at the beginning of a line.
std::optional<std::int64_t> numberAfter(const std::string& file, std::string_view key) {
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
std::optional<std::int64_t> numberIn(const std::string& file) {
  std::ifstream in(file);
  std::int64_t number = 0;
  return in >> number ? std::optional(number) : std::nullopt;
}

/// How a version of control groups says what a group may use, and uses.
struct GroupFiles {
  std::string_view controller, most, used, droppable;
};
constexpr GroupFiles version1{"memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                              "total_inactive_file"};
constexpr GroupFiles version2{"", "memory.max", "memory.current", "inactive_file"};

std::string withName(const std::string& folder, std::string_view name) {
  return folder + "/" + std::string(name);
}

void limit(std::optional<std::int64_t>& bytes, std::int64_t most) {
  bytes = std::max<std::int64_t>(0, std::min(bytes.value_or(most), most));
}

/// A group is also limited by all groups around it.
void limitByGroups(HostMemory& memory, const fs::path& root, const GroupFiles& files) {
  for (const std::string& folder : controlGroups(root, files.controller)) {
    if (const auto most = numberIn(withName(folder, files.most))) {
      limit(memory.whole, *most);
      const std::int64_t used = numberIn(withName(folder, files.used)).value_or(0) -
                                numberAfter(folder + "/memory.stat", files.droppable).value_or(0);
      limit(memory.available, *most - used);
    }
  }
}

}  // namespace

HostMemory hostMemory(const fs::path& root) {
  constexpr std::int64_t kibibyte = 1024;
  const std::string meminfo = root.string() + "/proc/meminfo";
  HostMemory memory;
  if (const auto whole = numberAfter(meminfo, "MemTotal:")) memory.whole = kibibyte * *whole;
  if (const auto free = numberAfter(meminfo, "MemAvailable:")) memory.available = kibibyte * *free;
  limitByGroups(memory, root, version2);
  limitByGroups(memory, root, version1);
  return memory;
}

}  // namespace sk
