// SPDX-License-Identifier: MIT
//
// Runs other programs and waits for them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sk_tool {

enum class Messages : std::uint8_t { Shown, Hidden };

/// Runs words[0], searched for in PATH unless it contains a slash, with the other words as its arguments and
/// with this process's standard streams, or without those for output. Returns its exit status, 128 plus the number of the signal that
/// ended it, or nullopt if there is no such program.
std::optional<int> runProgram(std::vector<std::string> words, Messages messages = Messages::Shown);

}  // namespace sk_tool
