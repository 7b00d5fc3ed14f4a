// SPDX-License-Identifier: MIT
//
// Promises: memory of a cache line or more is aligned to one; large memory begins at another offset in its
// page each time; all of it can be written; impossible sizes throw.
#include "native/memory.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <vector>

#include <catch2/catch.hpp>

namespace sk {
namespace {

constexpr std::size_t large = std::size_t{1} << 21;

std::uintptr_t addressOf(const ArrayMemory& memory) { return reinterpret_cast<std::uintptr_t>(memory.get()); }

TEST_CASE("memory of any size is there, and begins where a cache line does if it is as long") {
  for (const std::size_t bytes :
       {std::size_t{0}, std::size_t{1}, std::size_t{63}, std::size_t{65}, large - 1, large, 2 * large + 5}) {
    const ArrayMemory memory = allocated(bytes);
    INFO(bytes << " bytes");
    REQUIRE(memory != nullptr);
    CHECK(addressOf(memory) % (bytes < 64 ? alignof(std::max_align_t) : 64) == 0);
    for (std::size_t i = 0; i < bytes; ++i) memory[i] = static_cast<std::byte>(i);
  }
}

TEST_CASE("large arrays begin at different places in their pages, well behind those before them") {
  constexpr std::uintptr_t page = 4096;
  std::vector<ArrayMemory> arrays;
  for (int i = 0; i < 16; ++i) {
    arrays.push_back(allocated(large));
    for (const ArrayMemory& before : arrays) {
      if (before == arrays.back()) continue;
      CHECK((addressOf(arrays.back()) - addressOf(before)) % page >= 1024);
    }
  }
}

TEST_CASE("more memory than there can be throws") {
  constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  for (const std::size_t bytes : {all, all - 1, all - large, all / 2}) {
    CHECK_THROWS_AS(allocated(bytes), std::bad_alloc);
  }
}

}  // namespace
}  // namespace sk
