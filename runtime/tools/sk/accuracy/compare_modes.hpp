// SPDX-License-Identifier: MIT
//
// Runs the modes of a program in turns, A B C A B C ..., so that a busy machine disturbs all of them alike, and takes
// times by the wall clock around Device::finish() (GL's own timers are wrong on llvmpipe).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "accuracy/experiment.hpp"
#include "sk/device.hpp"

namespace sk_tool {

/// A mode that is ready to run.
struct Trial {
  std::function<void()> run;  ///< what is timed
  std::function<Grade()> grade;  ///< of the results of one run, which is the first
};

struct Mode {
  std::string name;
  std::function<Trial()> prepare;  ///< throws sk::Error where the device refuses, as the trial's run may
};

/// One row a mode. The first mode is the baseline, which no device refuses: its sk::Error passes through.
std::vector<Row> compareModes(sk::Device& device, const std::vector<Mode>& modes, int rounds);

}  // namespace sk_tool
