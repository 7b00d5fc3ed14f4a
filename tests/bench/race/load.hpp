// SPDX-License-Identifier: MIT
//
// Busy processes, as other programs of a shared machine are.
#pragma once

#include <vector>

#include <sys/types.h>

namespace race {

class Load {
 public:
  /// Starts processes that compute without end. Throws std::system_error if there can be none.
  explicit Load(int processes);
  ~Load();
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  void stop();
  std::vector<pid_t> processes_;
};

}  // namespace race
