// SPDX-License-Identifier: MIT
//
// Memory for the arrays of native streams, such that loops through several of them are fast. What is longer than a cache line begins
// where one does. Large arrays ask for large pages, as looking up small ones takes a good part of a loop's time, and begin at
// different places in them: processors take a load for one that waits for a store where the two differ in their pages alone, and
// keep equal places of all pages in the same few lines of a cache.
#pragma once

#include <cstddef>
#include <memory>

namespace sk {

/// Frees what begins some bytes before.
struct Freeing {
  std::size_t before = 0;
  void operator()(std::byte* memory) const;
};
using ArrayMemory = std::unique_ptr<std::byte[], Freeing>;

/// Uninitialised. Throws NoMemory (support/checked_size.hpp).
ArrayMemory allocated(std::size_t bytes);

}  // namespace sk
