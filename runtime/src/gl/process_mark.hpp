// SPDX-License-Identifier: MIT
//
// Whether an object is in the process that created it. After fork(), the child has copies of all objects of a driver, but not its
// threads, and shares the driver's connection to the GPU with its parent: calls of GL hang or destroy the parent's data.
#pragma once

#include <atomic>

namespace sk::gl {

class ProcessMark {
 public:
  /// Marks this process.
  ProcessMark() : forks_(watchedForks()) {}
  /// Whether this process is the one that was marked.
  bool isHere() const noexcept { return forks_ == forks.load(std::memory_order_relaxed); }

 private:
  /// The number of forks between the process in which the first mark was made and this one; asking the system for a process's number
  /// would take longer than the rest of a short call.
  static std::atomic<unsigned> forks;
  static unsigned watchedForks();

  unsigned forks_;
};

}  // namespace sk::gl
