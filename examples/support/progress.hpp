// SPDX-License-Identifier: MIT
//
// A progress bar on standard error where that is a terminal; elsewhere a plain line every five seconds.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace examples {

class Progress {
 public:
  Progress(std::string label, std::int64_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows that `done` of `total` steps are finished. Cheap enough to call often.
  void update(std::int64_t done);
  /// Takes the bar away, so that other output starts on an empty line.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  void drawBar(std::int64_t done, Clock::time_point now);

  std::string label_;
  std::int64_t total_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point lastDrawn_ = start_;
};

}  // namespace examples
