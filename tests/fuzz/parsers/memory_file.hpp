// SPDX-License-Identifier: MIT
//
// A file in memory that has a name: parsers that take the name of a file read an input without a disk.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fuzz {

class MemoryFile {
 public:
  /// Throws std::system_error where the system has no such files.
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Puts these bytes in place of what the file held. Throws std::system_error where there is no memory for them.
  void hold(std::span<const std::uint8_t> bytes) const;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace fuzz
