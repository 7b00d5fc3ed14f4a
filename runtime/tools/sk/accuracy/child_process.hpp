// SPDX-License-Identifier: MIT
//
// Other programs that this one runs and waits for.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sk_tool {

/// Runs words[0], looked for in PATH unless it has a slash, with the other words as its arguments; it reads and prints where
/// this process does. Its exit status, or 128 and the number of the signal that ended it; none where there is no
/// such program.
std::optional<int> runProgram(std::vector<std::string> words);

}  // namespace sk_tool
