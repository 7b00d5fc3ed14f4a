// SPDX-License-Identifier: MIT
//
// What tests of several examples use.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <sk/sk.hpp>

namespace examples {

/// A file with this text, which goes when the test does.
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

/// Native code, or the profile of this name on a software renderer.
inline sk::Device deviceNamed(const std::string& name) {
  if (name == "native") return sk::Device::native();
  return sk::Device({.device = "software", .profile = name});
}

}  // namespace examples
