// SPDX-License-Identifier: MIT
#include "support/processors.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#if defined(__linux__)
#include <sched.h>
#include <unistd.h>
#endif

namespace sk {

namespace {

namespace fs = std::filesystem;

/// The path of this process in a hierarchy of control groups: "" stands for version 2, and names for controllers of version 1.
std::optional<std::string> groupOf(const fs::path& root, std::string_view controller) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {  // NUMBER:CONTROLLERS:/PATH
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos || second + 1 >= line.size()) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool isOurs = controller.empty()
                            ? controllers == ",,"
                            : controllers.find("," + std::string(controller) + ",") != std::string::npos;
    if (isOurs) return line.substr(second + 2);
  }
  return std::nullopt;
}

/// Processors of version 2: "QUOTA PERIOD", or "max PERIOD".
std::optional<double> quotaOf(const fs::path& file) {
  std::ifstream in(file);
  double quota = 0, period = 0;
  if (!(in >> quota >> period) || quota <= 0 || period <= 0) return std::nullopt;
  return quota / period;
}

/// Processors of version 1, whose files hold one number each; -1 stands for no quota.
std::optional<double> oldQuotaOf(const fs::path& folder) {
  std::ifstream quotaFile(folder / "cpu.cfs_quota_us"), periodFile(folder / "cpu.cfs_period_us");
  double quota = 0, period = 0;
  if (!(quotaFile >> quota) || !(periodFile >> period) || quota <= 0 || period <= 0) return std::nullopt;
  return quota / period;
}

/// The least quota of a group and of those around it.
template <class Quota>
void limitByGroups(double& processors, const fs::path& all, fs::path group, Quota&& quota) {
  for (;; group = group.parent_path()) {
    if (const std::optional<double> most = quota(all / group)) processors = std::min(processors, *most);
    if (group.empty() || !group.has_relative_path()) return;
  }
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
  const fs::path all = root / "sys/fs/cgroup";
  if (const auto group = groupOf(root, ""))
    limitByGroups(most, all, *group, [](const fs::path& folder) { return quotaOf(folder / "cpu.max"); });
  if (const auto group = groupOf(root, "cpu")) limitByGroups(most, all / "cpu", *group, oldQuotaOf);
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

}  // namespace sk
