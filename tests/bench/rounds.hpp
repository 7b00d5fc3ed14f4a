// SPDX-License-Identifier: MIT
//
// How things are timed here: contenders take turns, round after round, and what is reported of two is the
// median of their ratios, so that a machine that slows down slows both. Wall clock; whoever is timed waits
// for the device. The first run of each, which compiles, is left out.
#pragma once

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

struct Comparison {
  Quartiles ratio;         ///< of each round: ours over theirs
  Quartiles ours;          ///< milliseconds for doing it once
  Quartiles theirs;
};

/// `sampleMilliseconds`: the work is repeated within a sample until it takes about as long.
Comparison compare(const Contender& ours, const Contender& theirs, int rounds, double sampleMilliseconds);

/// Milliseconds for doing it once.
Quartiles measure(const Contender& contender, int rounds, double sampleMilliseconds);

}  // namespace bench
