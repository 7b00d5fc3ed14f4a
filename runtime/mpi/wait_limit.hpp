// SPDX-License-Identifier: MIT
//
// SK_MPI_TIMEOUT: a rank that waits longer than this for other ranks says on
// standard error in which call, once, and goes on waiting. MPI has no way to
// give up what other ranks may still answer. Without the variable, waits are
// those of MPI.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <mpi.h>

namespace sk::mpi {

class WaitLimit {
 public:
  /// Reads SK_MPI_TIMEOUT, in seconds. Throws sk::Error unless it is a number
  /// above 0.
  static double secondsOfEnvironment();

  void setRank(int rank, int ranks) {
    rank_ = rank;
    ranks_ = ranks;
  }
  /// 0: there is no limit.
  void setSeconds(double seconds) { seconds_ = seconds; }
  bool isSet() const { return seconds_ > 0; }
  /// What is waited for from now on: the call, and how many calls there have
  /// been.
  void enter(std::string_view what, std::uint64_t number) {
    what_ = what;
    number_ = number;
  }

  /// Waits for all requests. `statuses` has one for each, or is empty. Returns
  /// an error of MPI.
  int wait(std::span<MPI_Request> requests, std::span<MPI_Status> statuses = {}) const;

 private:
  void report() const;

  int rank_ = 0, ranks_ = 1;
  double seconds_ = 0;
  std::string_view what_ = "a call";
  std::uint64_t number_ = 0;
};

}  // namespace sk::mpi
