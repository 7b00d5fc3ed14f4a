// SPDX-License-Identifier: MIT
//
// Runs other programs and waits for them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sk_tool {

/// Runs words[0], searched for in PATH unless it contains a slash, with the other words as its arguments and
/// with this process's standard streams. Returns its exit status, 128 plus the number of the signal that
/// ended it, or nullopt if there is no such program.
std::optional<int> runProgram(std::vector<std::string> words);

}  // namespace sk_tool
