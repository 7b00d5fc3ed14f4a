// SPDX-License-Identifier: MIT
#include "gl_device/memory/keep_heap.hpp"

#include <cstddef>
#include <cstdlib>

namespace sk {

void keepHeap() noexcept {
  // the largest that glibc learns from (M_MMAP_THRESHOLD), less its own bytes
  constexpr std::size_t bytes = (std::size_t{32} << 20) - (std::size_t{64} << 10);
  void* volatile block = std::malloc(bytes);  // a compiler may leave out what nobody sees
  std::free(block);
}

}  // namespace sk
