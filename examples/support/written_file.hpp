// SPDX-License-Identifier: MIT
//
// Files for tests, which go when the test does.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace examples {

/// A file with this text, for as long as it lives.
class WrittenFile {
 public:
  explicit WrittenFile(const std::string& text, std::filesystem::path path = "written.toml")
      : path_(std::move(path)) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~WrittenFile() { std::filesystem::remove(path_); }
  WrittenFile(const WrittenFile&) = delete;
  WrittenFile& operator=(const WrittenFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace examples
