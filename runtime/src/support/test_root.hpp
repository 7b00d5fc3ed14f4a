// SPDX-License-Identifier: MIT
//
// For tests of what the runtime reads from /proc and /sys.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace sk {

/// A folder that stands for the root of a machine, and vanishes with this.
class TestRoot {
 public:
  TestRoot() { std::filesystem::create_directories(path_); }
  ~TestRoot() { std::filesystem::remove_all(path_); }
  TestRoot(const TestRoot&) = delete;
  TestRoot& operator=(const TestRoot&) = delete;

  void write(const std::filesystem::path& file, const std::string& text) const {
    std::filesystem::create_directories((path_ / file).parent_path());
    std::ofstream(path_ / file) << text;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("sk_test_root_" + std::to_string(::getpid()));
};

}  // namespace sk
