// SPDX-License-Identifier: MIT
//
// Memory for the arrays of native streams, so that loops through several of them are fast. Arrays of a cache
// line or more are aligned to one. Large arrays use huge pages, because looking up small ones takes a good
// part of a loop's time. They begin at different offsets in a page: processors take a load to depend on an
// earlier store if their addresses differ only in the page (4K aliasing), and keep equal offsets of all pages
// in the same few lines of a cache.
#pragma once

#include <cstddef>
#include <memory>

namespace sk {

/// Bytes of a cache line, as aligned memory takes them.
inline constexpr std::size_t cacheLine = 64;

/// Frees memory that begins `before` bytes before the pointer.
struct Freeing {
  std::size_t before = 0;
  void operator()(std::byte* memory) const;
};
using ArrayMemory = std::unique_ptr<std::byte[], Freeing>;

/// Returns uninitialised memory. Throws NoMemory (support/checked_size.hpp).
ArrayMemory allocated(std::size_t bytes);

}  // namespace sk
