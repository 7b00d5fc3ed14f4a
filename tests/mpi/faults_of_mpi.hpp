// SPDX-License-Identifier: MIT
//
// Faults of one rank, for tests: functions of MPI that fail, by its profiling interface. Also counts what is left of requests,
// communicators, files and datatypes. ../faults/faults.hpp makes memory and drivers fail, but not within MPI.
#pragma once

namespace faults {

/// While it lives, function number `number` (from 1 on) on this thread fails, of those that this rank can try again, or whose failure
/// it can tell: messages, files, data.
class MpiFault {
 public:
  explicit MpiFault(long number);
  ~MpiFault();
  MpiFault(const MpiFault&) = delete;
  MpiFault& operator=(const MpiFault&) = delete;

  static bool hasFired();
};

struct Handles {
  int requests = 0, communicators = 0, files = 0, types = 0;
  bool operator==(const Handles&) const = default;
};
Handles handles();

}  // namespace faults
