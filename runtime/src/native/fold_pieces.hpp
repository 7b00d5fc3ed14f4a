// SPDX-License-Identifier: MIT
//
// Divides the blocks of a reduction's domain among threads. The pieces do not depend on the number of
// threads, and so neither do the results.
#pragma once

#include <algorithm>
#include <cstdint>

#include "native/call.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

/// A domain divided into blocks, and these into pieces: whole rows of a block, or parts of one row.
class BlockPieces {
 public:
  /// The most elements of a piece.
  static constexpr std::int64_t most = 1 << 14;

  /// `first` is the index of the domain's first element.
  BlockPieces(const native::Extents& domain, const native::Extents& block, const native::Extents& first = {})
      : block_(block), first_(first) {
    for (std::size_t d = 0; d < 4; ++d) blocks_[d] = domain[d] / block_[d];
    rows_ = block_[1] * block_[2] * block_[3];
    width_ = std::min(block_[0], most);
    perRow_ = (block_[0] + width_ - 1) / width_;
    height_ = perRow_ > 1 ? 1 : std::min(most / width_, rows_);
  }

  std::int64_t ofBlock() const { return perRow_ * ((rows_ + height_ - 1) / height_); }
  std::int64_t count() const { return ofBlock() * blocks_[0] * blocks_[1] * blocks_[2] * blocks_[3]; }
  std::int64_t elementsOfOne() const { return width_ * height_; }
  native::Extents blockAt(std::int64_t number) const {
    native::Extents at;
    for (std::size_t d = 0; d < 4; ++d) {
      at[d] = number % blocks_[d];
      number /= blocks_[d];
    }
    return at;
  }

  /// The number of pieces with `most` elements of one row, if the domain is that row: these come first. Else 0.
  std::int64_t wholeInRow() const { return count() == perRow_ ? block_[0] / most : 0; }
  /// Calls visit(first, count) for the rows of a piece.
  template <class Visit>
  void forEachRow(const native::Extents& block, std::int64_t piece, Visit&& visit) const {
    const std::int64_t row = piece / perRow_ * height_;
    const std::int64_t x = piece % perRow_ * width_;
    const std::int64_t rows = std::min(height_, rows_ - row);
    native::Extents in{x, row % block_[1], row / block_[1] % block_[2], row / block_[1] / block_[2]};
    for (std::int64_t k = 0; k < rows; ++k) {
      native::Extents first;
      for (std::size_t d = 0; d < 4; ++d) first[d] = first_[d] + block[d] * block_[d] + in[d];
      visit(first, std::min(width_, block_[0] - x));
      for (std::size_t d = 1; d < 4 && ++in[d] == block_[d]; ++d) in[d] = 0;
    }
  }

 private:
  native::Extents block_, first_;
  native::Extents blocks_;
  std::int64_t rows_;  ///< of a block
  std::int64_t width_;  ///< of a piece
  std::int64_t perRow_;
  std::int64_t height_;  ///< rows of a piece
};

/// Blocks of few elements along x, as in a sum of columns, in groups of neighbours that are folded side by
/// side.
class BlockGroups {
 public:
  BlockGroups(const native::Extents& domain, const native::Extents& block, std::int64_t longest)
      : block_(block), longest_(longest) {
    for (std::size_t d = 0; d < 4; ++d) blocks_[d] = domain[d] / block_[d];
  }

  /// The number of blocks that are folded side by side: at most `most`, and fewer where threads would be left without a
  /// group. Blocks do not depend on each other, and so neither do results on this.
  static std::int64_t sideBySide(const native::Extents& domain, const native::Extents& block,
                                 std::int64_t most) {
    constexpr std::int64_t least = 32;  // so that vectors, and the lines of caches, are full
    std::int64_t blocks = 1, elements = 1;
    for (std::size_t d = 0; d < 4; ++d) {
      blocks *= domain[d] / block[d];
      elements *= block[d];
    }
    const std::int64_t threads = native::threadsFor(blocks, elements);
    const std::int64_t ofThread = (blocks + threads - 1) / threads;
    return std::clamp((ofThread + least - 1) / least * least, least, std::max(least, most));
  }

  /// True if blocks are so narrow that a row of the domain crosses many of them.
  static bool areNarrow(const native::Extents& domain, const native::Extents& block) {
    return block[0] <= 8 && block[0] < domain[0];
  }

  std::int64_t count() const { return perRow() * blocks_[1] * blocks_[2] * blocks_[3]; }
  std::int64_t elementsOfOne() const {
    return std::min(longest_, blocks_[0]) * block_[0] * block_[1] * block_[2] * block_[3];
  }
  /// The first block of a group, and the number of its blocks.
  native::Extents firstOf(std::int64_t group) const {
    const std::int64_t row = group / perRow();
    return {group % perRow() * longest_, row % blocks_[1], row / blocks_[1] % blocks_[2],
            row / blocks_[1] / blocks_[2]};
  }
  std::int64_t lengthFrom(const native::Extents& first) const {
    return std::min(longest_, blocks_[0] - first[0]);
  }

 private:
  std::int64_t perRow() const { return (blocks_[0] + longest_ - 1) / longest_; }

  native::Extents block_, blocks_;
  std::int64_t longest_;
};

}  // namespace sk
