// SPDX-License-Identifier: MIT
//
// Runs many checks in child processes, so that one that crashes, hangs or ends its process costs no other, and
// is told like any other finding. It knows nothing of what is checked.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace fuzz {

/// What a check has to say of one input.
struct Verdict {
  std::string finding;  ///< what is wrong; empty if nothing is
  std::string tally;  ///< what it counts as in the summary: "accepted", "refused"
};

struct Finding {
  std::uint64_t number;
  std::string what;
  std::string log;  ///< the end of what the process said on standard error, where it died
};

struct Campaign {
  std::uint64_t first = 0, count = 0;
  std::uint64_t batch = 500;  ///< inputs to a process
  unsigned seconds = 10;  ///< of processor time for one input; more is a hang
  /// MiB that a process may take beyond what it begins with, or 0 for no limit; further allocations fail. Sanitizers, which
  /// reserve address space for themselves, have limits of their own (max_allocation_size_mb).
  std::uint64_t memory = 0;
  /// In the child, once before the first of a batch.
  std::function<void()> begin = [] {};
  /// In the child.
  std::function<Verdict(std::uint64_t number)> check = {};
  /// In the parent, as they come.
  std::function<void(const Finding&)> onFinding = {};
};

struct Summary {
  std::map<std::string, std::uint64_t> tallies;
  std::uint64_t inputs = 0, findings = 0;
  std::int64_t largestProcess = 0;  ///< KiB
};

/// A child that dies by a signal or with another status than 0 is a finding about the input that it was at; the
/// next child goes on behind it.
Summary run(const Campaign& campaign);

}  // namespace fuzz
