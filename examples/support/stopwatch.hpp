// SPDX-License-Identifier: MIT
//
// What calls take: wall-clock time, and passes of a device.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

#include <sk/device.hpp>

namespace examples {

/// Ask the device to finish before reading it: calls only queue work.
class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// The elapsed milliseconds of a call, until the device has finished all work that it queues.
template <class Call>
double millisecondsOf(sk::Device& device, const Call& call) {
  const Stopwatch stopwatch;
  call();
  device.finish();
  return stopwatch.milliseconds();
}

template <class Call>
sk::PassCount passesOf(sk::Device& device, const Call& call) {
  device.countPasses(true);
  call();
  const sk::PassCount count = device.passCount();
  device.countPasses(false);
  return count;
}

/// The larger of the two middle ones of an even number. There must be a value.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace examples
