// SPDX-License-Identifier: MIT
//
// Wall-clock time. Ask the device to finish before reading it: calls only queue work.
#pragma once

#include <chrono>

namespace examples {

class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace examples
