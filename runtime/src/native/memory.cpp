// SPDX-License-Identifier: MIT
#include "native/memory.hpp"

#include <cstddef>
#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "support/checked_size.hpp"

namespace sk {

namespace {

constexpr std::size_t smallPage = std::size_t{1} << 12;
constexpr std::size_t largePage = std::size_t{1} << 21;

/// The offset in a page of the next large array of this thread. Each of sixteen arrays begins 1 KiB or more
/// behind all before it in a page, so that a store to one is not taken for a dependency of a load from
/// another.
std::size_t nextPlace() {
  thread_local std::size_t number = 0;
  return number++ * 21 * cacheLine % smallPage;
}

/// `requested` is the size for the error message: what the caller requested, without the offset in the page.
std::byte* aligned(std::size_t alignment, std::size_t bytes, std::size_t requested) {
  void* memory = nullptr;
  if (posix_memalign(&memory, alignment, bytes) != 0) throw NoMemory(requested);
  return static_cast<std::byte*>(memory);
}

}  // namespace

void Freeing::operator()(std::byte* memory) const { std::free(memory - before); }

ArrayMemory allocated(std::size_t bytes) {
  if (bytes < cacheLine) return ArrayMemory(aligned(alignof(std::max_align_t), cacheLine, bytes));
  if (bytes < largePage) return ArrayMemory(aligned(cacheLine, bytes, bytes));
  const std::size_t place = nextPlace();
  const std::size_t whole = bytes + place;
  if (whole < bytes) throw NoMemory(bytes);
  std::byte* const memory = aligned(largePage, whole, bytes);
#if defined(__linux__)
  // The rest has small pages, and so has everything if the system has no huge ones.
  madvise(memory, whole / largePage * largePage, MADV_HUGEPAGE);
#endif
  return {memory + place, Freeing{place}};
}

}  // namespace sk
