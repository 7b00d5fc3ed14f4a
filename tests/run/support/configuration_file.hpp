// SPDX-License-Identifier: MIT
//
// A configuration file (docs/accuracy.md) for a test.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace run_tests {

/// The file exists while this object lives.
struct ConfigurationFile {
  explicit ConfigurationFile(const std::string& text)
      : path((std::filesystem::temp_directory_path() / "sk_test.toml").string() +
             std::to_string(::getpid())) {
    std::ofstream(path) << text;
  }
  ~ConfigurationFile() { std::filesystem::remove(path); }
  ConfigurationFile(const ConfigurationFile&) = delete;
  ConfigurationFile& operator=(const ConfigurationFile&) = delete;

  std::string path;
};

}  // namespace run_tests
