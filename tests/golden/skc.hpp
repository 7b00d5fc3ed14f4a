// SPDX-License-Identifier: MIT
//
// Runs skc as a user does, and reads and writes text files.
#pragma once

#include <filesystem>
#include <string>

namespace golden {

namespace fs = std::filesystem;

struct Outcome {
  int status;
  std::string output;   ///< standard output
  std::string errors;   ///< standard error
};

/// Runs a command line in `folder`.
Outcome run(const fs::path& folder, const std::string& command);

/// `skc ARGUMENTS FILE` in the file's own folder, so that messages and #line name it without folders.
Outcome skc(const std::string& arguments, const fs::path& file);

/// The whole file; "" where there is none.
std::string readFile(const fs::path& file);
void writeFile(const fs::path& file, const std::string& text);

/// An empty folder of this name for what a test writes.
fs::path workFolder(const std::string& name);

}  // namespace golden
