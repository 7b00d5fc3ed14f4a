// SPDX-License-Identifier: MIT
//
// Running a command of the shell and taking what it prints.
#pragma once

#include <filesystem>
#include <string>

namespace docs {

struct Outcome {
  int status;
  std::string output;   ///< of both streams, in order
};

/// Runs `command` by bash in `folder`, with the folder of skc in front of PATH.
Outcome run(const std::string& command, const std::filesystem::path& folder);

/// An empty folder of this name for one test's files.
std::filesystem::path workFolder(const std::string& name);

}  // namespace docs
