// SPDX-License-Identifier: MIT
//
// A configuration file (docs/accuracy.md) for a test.
#pragma once

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace run_tests {

/// The file exists while this object lives.
struct ConfigurationFile {
  explicit ConfigurationFile(const std::string& text) : path(newPath()) { std::ofstream(path) << text; }
  ~ConfigurationFile() { std::filesystem::remove(path); }
  ConfigurationFile(const ConfigurationFile&) = delete;
  ConfigurationFile& operator=(const ConfigurationFile&) = delete;

  std::string path;

 private:
  /// A path that no other process and no other object of this one uses.
  static std::string newPath() {
    static std::atomic<int> number = 0;
    const std::string name = "sk_test_" + std::to_string(::getpid()) + "_" + std::to_string(++number);
    return (std::filesystem::temp_directory_path() / (name + ".toml")).string();
  }
};

}  // namespace run_tests
