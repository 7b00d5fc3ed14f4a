// SPDX-License-Identifier: MIT
//
// Reports of the ranks of one program: each rank adds its own to a file, and the last one makes one report of all.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "shadow/report.hpp"

namespace sk::shadow {

/// The rank of this process and the number of ranks, from the variables that MPI's launchers set; 0 of 1 without them.
struct RankOfProcess {
  int rank = 0, ranks = 1;
};
RankOfProcess rankOfProcess();

/// Adds a report to those of other ranks in `file`, which is removed once all are there. Calls use(reports) with those that are
/// there, while no other rank does so. Throws sk::Error if the file cannot be read or written.
void addToRanks(const std::string& file, const Report& report,
                const std::function<void(std::vector<Report>)>& use);

/// One report of all ranks: kernels, streams and results of one name are one.
Report merged(std::vector<Report> reports);

}  // namespace sk::shadow
