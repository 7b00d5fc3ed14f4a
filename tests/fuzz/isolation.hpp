// SPDX-License-Identifier: MIT
//
// Runs many checks in child processes, so that a check that crashes, hangs or ends its process does not stop the others and
// is a finding like any other. Knows nothing about what is checked.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace fuzz {

/// The result of checking one input.
struct Verdict {
  std::string finding;  ///< what is wrong; empty if nothing is
  std::string tally;  ///< the input's category in the summary, such as "accepted" or "refused"
  bool endsProcess = false;  ///< the process may be damaged: the next input needs another
};

struct Finding {
  std::uint64_t number;
  std::string what;
  std::string log;  ///< if the process died: the end of its standard error
};

struct Campaign {
  std::uint64_t first = 0, count = 0;
  std::uint64_t batch = 500;  ///< inputs per process
  unsigned seconds = 10;  ///< processor time for one input; more is a hang
  /// MiB that a process may allocate beyond its initial size, or 0 for no limit; further allocations fail. Ignored under
  /// sanitizers, which reserve address space and have their own limit (max_allocation_size_mb).
  std::uint64_t memory = 0;
  /// Runs in the child, once before the first input of a batch.
  std::function<void()> begin = [] {};
  /// Runs in the child.
  std::function<Verdict(std::uint64_t number)> check = {};
  /// Runs in the parent, at each finding.
  std::function<void(const Finding&)> onFinding = {};
};

struct Summary {
  std::map<std::string, std::uint64_t> tallies;
  std::uint64_t inputs = 0, findings = 0;
  std::int64_t largestProcess = 0;  ///< KiB
};

/// Runs a campaign. A child that ends by a signal or with a status other than 0 is a finding about its current input; the
/// next child continues after that input.
Summary run(const Campaign& campaign);

}  // namespace fuzz
