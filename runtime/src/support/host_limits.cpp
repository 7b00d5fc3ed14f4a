// SPDX-License-Identifier: MIT
#include "support/host_limits.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace sk {

// Strings, since paths of libstdc++ 12 free memory twice where it is exhausted while they are joined.
std::vector<std::string> controlGroups(const std::filesystem::path& root, std::string_view controller) {
  const std::string start = root.string() == "/" ? std::string() : root.string();
  std::string own;  // the outermost group if no line tells
  std::ifstream in(start + "/proc/self/cgroup");
  for (std::string line;
       std::getline(in, line);) {  // NUMBER:CONTROLLERS:/PATH; version 2 names no controllers
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos || line.size() <= second + 1) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool isOurs = controller.empty()
                            ? line.starts_with("0::/")
                            : controllers.find("," + std::string(controller) + ",") != std::string::npos;
    if (isOurs) own = line.substr(second + 1);
  }
  while (own.ends_with('/')) own.pop_back();
  std::vector<std::string> folders;
  const std::string all =
      start + "/sys/fs/cgroup" + (controller.empty() ? "" : "/" + std::string(controller));
  for (;; own.resize(own.rfind('/'))) {
    folders.push_back(all + own);
    if (own.find('/') == std::string::npos) return folders;
  }
}

}  // namespace sk

#if defined(__linux__)
#include <sched.h>
#include <unistd.h>
#endif

namespace sk {

namespace {

namespace fs = std::filesystem;

/// Processors of version 2: "QUOTA PERIOD", or "max PERIOD".
std::optional<double> quotaOf(const std::string& file) {
  std::ifstream in(file);
  double quota = 0, period = 0;
  if (!(in >> quota >> period) || quota <= 0 || period <= 0) return std::nullopt;
  return quota / period;
}

/// Processors of version 1, whose files hold one number each; -1 stands for no quota.
std::optional<double> oldQuotaOf(const std::string& folder) {
  std::ifstream quotaFile(folder + "/cpu.cfs_quota_us"), periodFile(folder + "/cpu.cfs_period_us");
  double quota = 0, period = 0;
  if (!(quotaFile >> quota) || !(periodFile >> period) || quota <= 0 || period <= 0) return std::nullopt;
  return quota / period;
}

/// Ranks of an MPI program on this machine, by what starters of ranks leave in the environment; 1 if there is nothing.
int ranksHere() {
  for (const char* name :
       {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "PMIX_LOCAL_SIZE", "MV2_COMM_WORLD_LOCAL_SIZE"}) {
    if (const char* text = std::getenv(name)) return std::clamp(std::atoi(text), 1, 1 << 20);
  }
  return 1;
}

}  // namespace

int withinQuota(int processors, const fs::path& root) {
  double most = processors;
  for (const std::string& folder : controlGroups(root, ""))
    most = std::min(most, quotaOf(folder + "/cpu.max").value_or(most));
  for (const std::string& folder : controlGroups(root, "cpu"))
    most = std::min(most, oldQuotaOf(folder).value_or(most));
  return std::max(1, static_cast<int>(most));
}

int shareOfRank(int usable, int online, int ranks) {
  return usable * static_cast<std::int64_t>(ranks) <= online ? usable : std::max(1, online / ranks);
}

int availableProcessors(const fs::path& root) {
  int usable = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  int online = usable;
#if defined(__linux__)
  online = std::max(1, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
  for (int most = 1024; most <= 1 << 20; most *= 2) {
    cpu_set_t* const set = CPU_ALLOC(static_cast<std::size_t>(most));
    if (set == nullptr) break;
    const std::size_t bytes = CPU_ALLOC_SIZE(static_cast<std::size_t>(most));
    const bool isRead = sched_getaffinity(0, bytes, set) == 0;
    if (isRead) usable = std::max(1, CPU_COUNT_S(bytes, set));
    CPU_FREE(set);
    if (isRead) break;  // else there are more processors than the set holds
  }
#endif
  return shareOfRank(withinQuota(usable, root), online, ranksHere());
}

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

std::int64_t bytesOfCache([[maybe_unused]] int level) {
#if defined(__linux__) && defined(_SC_LEVEL2_CACHE_SIZE)
  const int name = level == 1   ? _SC_LEVEL1_DCACHE_SIZE
                   : level == 2 ? _SC_LEVEL2_CACHE_SIZE
                                : _SC_LEVEL3_CACHE_SIZE;
  return std::max<std::int64_t>(sysconf(name), 0);
#else
  return 0;
#endif
}

}  // namespace sk
