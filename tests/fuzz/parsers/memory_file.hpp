// SPDX-License-Identifier: MIT
//
// A file in memory that has a path, for parsers that take the path of a file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fuzz {

class MemoryFile {
 public:
  /// Throws std::system_error if the system cannot make such a file.
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Replaces the file's contents. Throws std::system_error if there is not enough memory.
  void hold(std::span<const std::uint8_t> bytes) const;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace fuzz
