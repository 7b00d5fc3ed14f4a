// SPDX-License-Identifier: MIT
#include "support/processors.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "support/control_groups.hpp"

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

}  // namespace sk
