// SPDX-License-Identifier: MIT
#include "wait_limit.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk::mpi {

double WaitLimit::secondsOfEnvironment() {
  const char* const value = std::getenv("SK_MPI_TIMEOUT");
  if (value == nullptr || *value == '\0') return 0;
  const std::string_view text(value);
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error == std::errc() && end == text.data() + text.size() && seconds > 0) return seconds;
  throw Error(fmt::format("SK_MPI_TIMEOUT is '{}'; give a number of seconds above 0, or unset it", value));
}

int WaitLimit::wait(std::span<MPI_Request> requests, std::span<MPI_Status> statuses) const {
  const auto count = static_cast<int>(requests.size());
  MPI_Status* const to = statuses.empty() ? MPI_STATUSES_IGNORE : statuses.data();
  if (!isSet()) return MPI_Waitall(count, requests.data(), to);
  using std::chrono::microseconds;
  const auto start = std::chrono::steady_clock::now();
  const auto limit = start + std::chrono::duration<double>(seconds_);
  bool isReported = false;
  microseconds pause{0};
  for (;;) {
    int isDone = 0;
    const int status = MPI_Testall(count, requests.data(), &isDone, to);
    if (status != MPI_SUCCESS || isDone != 0) return status;
    const auto now = std::chrono::steady_clock::now();
    if (!isReported && now > limit) {
      report();
      isReported = true;
    }
    if (now - start < std::chrono::milliseconds(1)) continue;  // most waits end here
    pause = std::min(pause + microseconds(10), microseconds(1000));
    std::this_thread::sleep_for(pause);
  }
}

void WaitLimit::report() const {
  const std::string text = fmt::format(
      "sk: rank {} of {} has waited {} s for other ranks in {} "
      "(call {} of its domain)\n",
      rank_, ranks_, seconds_, what_, number_);
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace sk::mpi
