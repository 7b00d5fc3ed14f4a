// SPDX-License-Identifier: MIT
//
// Tells a cache of what belongs to descriptors, such as compiled programs, when to drop what belongs to a library that has been
// unloaded. Descriptors are known by their addresses, which the next library may get.
#pragma once

#include <cstdint>
#include <utility>

#include "sk/linked_file.hpp"

namespace sk {

class UnloadWatch {
 public:
  /// Whether a file has been unloaded since the last call. The cache must ask before each look-up, and then drop all
  /// entries whose object is not loaded any more (LinkedFile::isLoaded()).
  bool hasChanged() noexcept {
    const std::uint64_t now = program::LinkedFile::unloads();
    return std::exchange(seen_, now) != now;
  }

 private:
  std::uint64_t seen_ = program::LinkedFile::unloads();
};

}  // namespace sk
