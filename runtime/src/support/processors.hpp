// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace sk {

/// How many threads this process may run at once: the processors that it may use, less what quotas of control groups and other
/// ranks of an MPI program on this machine take. At least 1. Files are read below `root`; tests have their own.
int availableProcessors(const std::filesystem::path& root = "/");

/// Processors of a quota of control groups, rounded down, but at least 1; `processors` where there is no quota below it.
int withinQuota(int processors, const std::filesystem::path& root);

/// A rank's share of a machine with `online` processors, of which it may use `usable` and on which `ranks` ranks run.
int shareOfRank(int usable, int online, int ranks);

}  // namespace sk
