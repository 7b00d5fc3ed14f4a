// SPDX-License-Identifier: MIT
#include "rounds.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace bench {
namespace {

double millisecondsNow(Time clock) {
  timespec now{};
  clock_gettime(clock == Time::Wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Milliseconds for `times` times.
double sample(const Contender& contender, int times, Time clock = Time::Wall) {
  const double start = millisecondsNow(clock);
  contender(times);
  return millisecondsNow(clock) - start;
}

int timesFor(const Contender& contender, double milliseconds, Time clock = Time::Wall) {
  sample(contender, 1);  // compiles
  const double once = sample(contender, 1, clock);
  return std::clamp(static_cast<int>(std::lround(milliseconds / std::max(once, 1e-3))), 1, 100'000);
}

}  // namespace

Quartiles quartilesOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double part) {
    const double place = part * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {at(0.25), at(0.5), at(0.75)};
}

void compare(const Contender& ours, const Contender& theirs, int rounds, double sampleMilliseconds,
             Comparison& all, Time clock) {
  const int times =
      std::max(timesFor(ours, sampleMilliseconds, clock), timesFor(theirs, sampleMilliseconds, clock));
  for (int round = 0; round < rounds; ++round) {
    // A B, B A, A B ...: what slows down or warms up in a round favours neither.
    const bool oursFirst = round % 2 == 0;
    const double first = sample(oursFirst ? ours : theirs, times, clock) / times;
    const double second = sample(oursFirst ? theirs : ours, times, clock) / times;
    all.ours.push_back(oursFirst ? first : second);
    all.theirs.push_back(oursFirst ? second : first);
    all.ratios.push_back(all.ours.back() / all.theirs.back());
  }
}

Quartiles measure(const Contender& contender, int rounds, double sampleMilliseconds) {
  const int times = timesFor(contender, sampleMilliseconds);
  std::vector<double> once;
  for (int round = 0; round < rounds; ++round) once.push_back(sample(contender, times) / times);
  return quartilesOf(once);
}

}  // namespace bench
