// SPDX-License-Identifier: MIT
//
// The program as it is: what it reads, whether it reads the same in each run, and what its kernels take.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tune/application.hpp"
#include "tune/judge.hpp"
#include "tune/setting.hpp"

namespace sk_tool::tune {

struct Baseline {
  sk::results::Process process;
  sk::results::Process times;  ///< of a run that waits around each kernel, on devices that queue calls
  std::vector<std::string> differing;  ///< names of reads that are not the same in two runs
  double wall = 0;  ///< seconds of the longest run

  /// Whether the times of kernels are known only if the program waits around each.
  bool queues() const { return !process.hasTimes; }
};

/// Runs the program two or three times. Throws std::runtime_error if it fails.
Baseline measure(const Application& application);

/// Throws std::runtime_error if there is nothing to choose or to judge, or if the configuration to start from is of another program.
void checkBaseline(const Application& application, const Baseline& base, const BaseFile& file);

/// Throws std::runtime_error if a wanted result differs from run to run, or if all do.
void checkRepeats(const Application& application, const Baseline& base, std::span<const Wanted> wanted);

}  // namespace sk_tool::tune
