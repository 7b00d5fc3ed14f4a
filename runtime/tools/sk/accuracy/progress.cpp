// SPDX-License-Identifier: MIT
#include "accuracy/progress.hpp"

#include <cstdio>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>

namespace sk_tool {

Progress::Progress(std::string what) : what_(std::move(what)), isShown_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (isShown_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::show(double done) {
  const auto now = std::chrono::steady_clock::now();
  if (!isShown_ || now - last_ < std::chrono::milliseconds(200)) return;
  last_ = now;
  fmt::print(stderr, "\r\x1b[K{}: {:.0f} %", what_, 100 * done);
  std::fflush(stderr);
}

}  // namespace sk_tool
