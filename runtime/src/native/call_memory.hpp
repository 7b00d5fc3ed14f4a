// SPDX-License-Identifier: MIT
//
// Memory for what a call needs while it runs. Small calls, which should take well below a microsecond,
// allocate nothing on the heap.
#pragma once

#include <cstddef>
#include <memory_resource>

namespace sk {

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
