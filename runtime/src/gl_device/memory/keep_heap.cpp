// SPDX-License-Identifier: MIT
#include "gl_device/memory/keep_heap.hpp"

#include <cstddef>
#include <cstdlib>

namespace sk {

void keepHeap() noexcept {
  // the largest block from which glibc adapts its thresholds (M_MMAP_THRESHOLD), less room for its header
  constexpr std::size_t bytes = (std::size_t{32} << 20) - (std::size_t{64} << 10);
  void* volatile block = std::malloc(bytes);  // volatile: a compiler may remove an unused allocation
  std::free(block);
}

}  // namespace sk
