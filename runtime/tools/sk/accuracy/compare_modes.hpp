// SPDX-License-Identifier: MIT
//
// Runs the modes of a program alternately, A B C A B C ..., so that a busy machine affects all modes equally.
// Times are wall-clock times around Device::finish(), because GL's own timers are wrong on llvmpipe.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "accuracy/experiment.hpp"
#include "sk/device.hpp"

namespace sk_tool {

/// A mode that is ready to run.
struct Trial {
  std::function<void()> run;  ///< the timed part
  std::function<Grade()> grade;  ///< of the results of the first run
};

struct Mode {
  std::string name;
  std::function<Trial()> prepare;  ///< throws sk::Error if the device rejects the mode, as `run` may
};

/// Returns one row per mode. The first mode is the baseline, which every device supports: its sk::Error is
/// not caught.
std::vector<Row> compareModes(sk::Device& device, const std::vector<Mode>& modes, int rounds);

}  // namespace sk_tool
