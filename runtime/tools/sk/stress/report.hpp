// SPDX-License-Identifier: MIT
//
// What sk stress has found, as text and as JSON (docs/json.md).
#pragma once

#include <string>
#include <vector>

#include "stress/judge.hpp"

namespace sk_tool::stress {

struct Report {
  std::string command, device;
  std::vector<Run> runs;  ///< the program as it is, then the cases
  std::vector<std::string> notes = {};

  /// How many runs break the program where it must not break.
  std::size_t broken() const;
  /// How many runs print() may list: all cases, and the program as it is if something was found.
  std::size_t listed() const;
};

void print(const Report& report, bool isAll);
/// Throws std::runtime_error if the file cannot be written.
void writeJson(const Report& report, const std::string& file);

}  // namespace sk_tool::stress
