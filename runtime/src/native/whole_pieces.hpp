// SPDX-License-Identifier: MIT
//
// Folds whole pieces of a row whose elements are read in place, as in a sum of a stream. It gives what PieceFolder gives, with
// a fraction of its work around the calls of the code: a thread that helps needs a few lines of memory that another one has
// written, where each line takes as long as hundreds of elements.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "native/fold_pieces.hpp"
#include "native/fold_program.hpp"

namespace sk {

/// What the threads of one fold share.
class alignas(64) WholePieces {
 public:
  /// Returns nullopt if no piece can be folded so: the fold depends on the order of elements, reads more than elements that lie
  /// one behind the other, has outputs, or takes too much memory. `program` must outlive the result.
  static std::optional<WholePieces> of(const FoldProgram& program, const BlockPieces& pieces);

  /// The number of pieces that fold() can fold, which come first.
  std::int64_t count() const { return count_; }
  /// Folds a piece, and packs its accumulators (StateColumns::pack).
  void fold(std::int64_t piece, std::byte* result) const;

 private:
  static constexpr std::size_t mostArrays = 4;
  static constexpr std::int64_t columns = BlockPieces::most / leafRounds;  ///< of a piece's leaves, in all
  struct Array {
    const std::byte* first;  ///< the element at x = 0 of the row
    std::int64_t bytes;  ///< of an element
  };

  WholePieces(const FoldProgram& program, std::int64_t count);

  Bound<native::FoldFunction> fold_;
  Bound<native::CombineFunction> combine_;
  std::int64_t count_, side_;
  std::size_t arrayCount_, scalarCount_;
  std::array<Array, mostArrays> arrays_{};
  std::array<std::size_t, mostArrays> scalarBytes_{};
  native::Extents first_;
};

}  // namespace sk
