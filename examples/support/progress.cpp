// SPDX-License-Identifier: MIT
#include "support/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace examples {

Progress::Progress(std::string label, std::int64_t total)
    : label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() { clear(); }

void Progress::update(std::int64_t done) {
  const Clock::time_point now = Clock::now();
  if (now - lastDrawn_ < std::chrono::milliseconds(terminal_ ? 100 : 5000)) return;
  lastDrawn_ = now;
  if (terminal_) {
    drawBar(done, now);
  } else {
    fmt::print(stderr, "{}: {} %\n", label_, 100 * done / total_);
  }
}

void Progress::drawBar(std::int64_t done, Clock::time_point now) {
  constexpr int width = 32;
  const double part = static_cast<double>(done) / static_cast<double>(total_);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double left = part > 0 ? seconds * (1.0 - part) / part : 0.0;
  const int filled = static_cast<int>(part * width);
  fmt::print(stderr, "\r{} [{:=<{}}{: <{}}] {:3.0f} %  {:.0f} steps/s  {:.0f} s left \x1b[K", label_, "",
             filled, "", width - filled, 100.0 * part,
             seconds > 0 ? static_cast<double>(done) / seconds : 0.0, left);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  if (std::exchange(drawn_, false)) {
    std::fputs("\r\x1b[K", stderr);
    std::fflush(stderr);
  }
}

}  // namespace examples
