// SPDX-License-Identifier: MIT
//
// Faults of one rank, for tests: allocations of the host that fail, and functions of MPI that do, by its profiling interface. Also
// counts what is left of requests, communicators, files and datatypes.
#pragma once

#include <string>

namespace faults {

enum class Kind : unsigned char {
  Allocation,  ///< operator new
  Mpi,  ///< a function that this rank can try again, or whose failure it can tell: messages, files, data
};

/// While it lives, opportunity number `number` (from 1 on) on this thread fails.
class Fault {
 public:
  Fault(Kind kind, long number);
  ~Fault();
  Fault(const Fault&) = delete;
  Fault& operator=(const Fault&) = delete;

  static bool hasFired();
  /// The function of MPI that has failed.
  static const char* where();
};

struct Handles {
  int requests = 0, communicators = 0, files = 0, types = 0;
  bool operator==(const Handles&) const = default;
};
Handles handles();

}  // namespace faults
