// SPDX-License-Identifier: MIT
//
// Runs another program with limits of time, memory and output, for input that nobody has looked at.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace sk_tool {

struct ProcessLimits {
  int cpuSeconds = 10;
  std::chrono::seconds wallTime{30};
  std::size_t memory = std::size_t{2} << 30;        ///< bytes of address space; 0: no limit
  std::size_t file = std::size_t{16} << 20;         ///< bytes of each file that it writes
  std::size_t output = std::size_t{8} << 20;        ///< bytes of each of its standard streams
};

struct ProcessResult {
  enum class End { Exit, Signal, Time, Output, NotStarted };
  End end = End::NotStarted;
  int status = 0;   ///< exit status, or number of the signal
  std::string output, messages;
};

/// Runs words[0], a path, with the other words as its arguments, and waits for it. It and all processes that it starts end by a
/// limit. Standard input is empty. Safe to call from several threads.
ProcessResult runLimited(const std::vector<std::string>& words, const ProcessLimits& limits);

}  // namespace sk_tool
