// SPDX-License-Identifier: MIT
//
// Memory for the arrays of native streams, so that loops through several of them are fast. Arrays of a cache
// line or more are aligned to one. Large arrays use huge pages, because looking up small ones takes a good
// part of a loop's time. They begin at different offsets in a page: processors take a load to depend on an
// earlier store if their addresses differ only in the page (4K aliasing), and keep equal offsets of all pages
// in the same few lines of a cache.
//
// CallMemory is for what a call needs while it runs. Small calls, which should take well below a microsecond,
// allocate nothing on the heap.
#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>

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

class CallMemory {
 public:
  CallMemory() = default;
  CallMemory(const CallMemory&) = delete;
  CallMemory& operator=(const CallMemory&) = delete;

  std::pmr::memory_resource* get() { return &resource_; }

 private:
  alignas(std::max_align_t) std::byte first_[16384];
  std::pmr::monotonic_buffer_resource resource_{first_, sizeof first_};
};

}  // namespace sk
