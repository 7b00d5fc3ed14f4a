// SPDX-License-Identifier: MIT
//
// How things are timed here: contenders take turns, round after round, and what is reported of two is the
// median of their ratios, so that a machine that slows down slows both. Whoever is timed waits
// for the device. The first run of each, which compiles, is left out.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace bench {

struct Quartiles {
  double low;
  double median;
  double high;
};
Quartiles quartilesOf(std::vector<double> values);

/// Does its work so many times, waits for the device, and gives nothing back.
using Contender = std::function<void(int times)>;

/// The time of all threads of this process counts where it is the processor that works: what else a machine does then
/// matters less.
enum class Time : std::uint8_t { Wall, Processor };

/// What two contenders took, round by round.
struct Comparison {
  std::vector<double> ratios;  ///< ours over theirs
  std::vector<double> ours;  ///< milliseconds for doing it once
  std::vector<double> theirs;
};

/// Adds `rounds` rounds. `sampleMilliseconds`: the work is repeated within a sample until it takes about as
/// long.
void compare(const Contender& ours, const Contender& theirs, int rounds, double sampleMilliseconds,
             Comparison& all, Time clock = Time::Wall);

/// Milliseconds for doing it once.
Quartiles measure(const Contender& contender, int rounds, double sampleMilliseconds);

}  // namespace bench
