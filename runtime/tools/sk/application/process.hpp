// SPDX-License-Identifier: MIT
//
// Runs the program that a command examines, without its output and with a limit of time. Must not know what the command wants of it.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sk_tool {

using EnvironmentChanges = std::map<std::string, std::optional<std::string>>;  ///< to set, or to unset

struct EndedProcess {
  std::optional<int> status;  ///< as waitpid() tells; nullopt: it was ended at the limit
  double wall = 0;  ///< seconds
  std::string messages;  ///< the last lines of its standard error, each after "\n  "; "" if there are none

  bool isSignalled() const;
  /// 0 if it was signalled.
  int exitStatus() const;
  /// "ends by signal 11 (...)", "ends with status 1", or "has not ended after 12 s", with the last messages; "" if it ended with
  /// status 0.
  std::string failure() const;
};

/// Runs words[0], searched for in PATH unless it contains a slash, and ends it and what it has started at the limit. Throws
/// std::runtime_error if there is no such program, or no process for it.
EndedProcess runLimited(std::vector<std::string> words, const EnvironmentChanges& environment,
                        std::chrono::duration<double> limit);

}  // namespace sk_tool
