// SPDX-License-Identifier: MIT
//
// What the loops run over in one go: neighbours along x. Parameters are placed at the first of them, so that the inner loop adds
// the number of the element to a pointer and computes no index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "sk/native/call.hpp"
#include "sk/native/vector.hpp"

namespace sk::native {

using Index = Vec<Int, 4>;

inline Index toIndex(const Extents& extents) {
  Index index{};
  for (std::size_t d = 0; d < 4; ++d) index.components[d] = Int(extents[d]);
  return index;
}

/// Memory for what parameters lay out for a chunk. Each chunk asks for as much as the one before it, in the same order.
class Scratch {
 public:
  void* take(std::size_t bytes) {
    if (next_ == blocks_.size())
      blocks_.push_back({std::make_unique_for_overwrite<std::byte[]>(bytes), bytes});
    Block& block = blocks_[next_++];
    if (block.size < bytes) block = {std::make_unique_for_overwrite<std::byte[]>(bytes), bytes};
    return block.bytes.get();
  }
  void restart() { next_ = 0; }

 private:
  struct Block {
    std::unique_ptr<std::byte[]> bytes;
    std::size_t size;
  };
  std::vector<Block> blocks_;
  std::size_t next_ = 0;
};

/// `count` elements of the domain from `first` on, along x.
struct Chunk {
  Extents first;
  int count;
  Scratch& scratch;
};

/// Elements in a chunk where something is laid out for it: that stays in the nearest cache.
inline constexpr int laidOut = 512;

}  // namespace sk::native
