// SPDX-License-Identifier: MIT
#include "parsers/memory_file.hpp"

#include <cerrno>
#include <system_error>

#include <sys/mman.h>
#include <unistd.h>

namespace fuzz {

MemoryFile::MemoryFile() : file_(::memfd_create("input", MFD_CLOEXEC)) {
  if (file_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
}

MemoryFile::~MemoryFile() { ::close(file_); }

void MemoryFile::hold(std::span<const std::uint8_t> bytes) const {
  const auto size = static_cast<ssize_t>(bytes.size());
  if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, bytes.data(), bytes.size(), 0) != size) {
    throw std::system_error(errno, std::generic_category(), "a file in memory");
  }
}

}  // namespace fuzz
