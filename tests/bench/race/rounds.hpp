// SPDX-License-Identifier: MIT
//
// How contenders are timed: round after round, each once a round, and another one first in each round, so that a machine
// that slows down slows all of them. A GPU has work before each of them. Google Benchmark runs and counts; the time is the wall clock around Task::run().
#pragma once

#include <string>
#include <vector>

#include "awake.hpp"
#include "contender.hpp"

namespace race {

struct Runner {
  std::string name;
  Task* task;
};

struct Patience {
  int rounds;  ///< at most
  double sampleSeconds;  ///< a task is repeated within a round until it takes as long
  double groupSeconds;  ///< after that, rounds are done with once there are three
};

/// Seconds that each runner takes for doing it once, round by round. All have run before.
std::vector<std::vector<double>> race(const std::vector<Runner>& runners, const Patience& patience,
                                      const Awake& awake);

}  // namespace race
