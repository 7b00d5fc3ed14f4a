// SPDX-License-Identifier: MIT
//
// Folds a piece of a block (BlockPieces) in a number of steps that grows with its elements divided by the columns that
// are folded side by side.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory_resource>

#include "native/call_memory.hpp"
#include "native/fold_pieces.hpp"
#include "native/fold_program.hpp"
#include "native/leaf_folder.hpp"

namespace sk {

/// The largest power of 2 that is not greater than `number`; 0 for 0.
inline std::int64_t powerUpTo(std::int64_t number) {
  return static_cast<std::int64_t>(std::bit_floor(static_cast<std::uint64_t>(number)));
}

inline ColumnCombiner combinerOf(const FoldProgram& program,
                                 std::pmr::memory_resource* memory = std::pmr::get_default_resource()) {
  return {program.shape, program.combine.function, program.combine.lanes, program.combine.frame, memory};
}

/// Folds pieces of blocks, one after the other. Each thread has its own.
class PieceFolder {
 public:
  PieceFolder(const FoldProgram& program, const BlockPieces& pieces)
      : program_(program),
        pieces_(pieces),
        side_(sideOf(program.shape)),
        leaves_(program, memory_.get()),
        combiner_(combinerOf(program, memory_.get())),
        runs_(program.shape, combiner_, 1, memory_.get()),
        columnRuns_(program.shape, combiner_, side_, memory_.get()),
        rest_(program.shape, side_, memory_.get()),
        group_(program.isCommutative ? mostLeaves * side_ : groupOf(program.shape)),
        leafColumns_(program.shape, group_, memory_.get()),
        orderedColumns_(program.shape, program.isCommutative ? 0 : group_, memory_.get()) {}

  /// Folds a piece of a block, which has at least one element, to one column.
  const StateColumns& fold(const native::Extents& block, std::int64_t piece);

 private:
  void foldColumns(std::int64_t x, std::int64_t count);
  /// The number of leaves of whole columns that one call can fold, a power of 2; 0 or 1 if it cannot fold
  /// several.
  std::int64_t wholeLeaves(std::int64_t count) const;
  /// Combines the columns of the leaves as if these were folded one after the other.
  void foldWholeLeaves(std::int64_t x, std::int64_t leaves);
  /// Folds the remainder of a row: one element for some of the columns. The remainders of several rows form a
  /// leaf.
  void foldRest(std::int64_t x, std::int64_t count);
  /// Combines whole columns and the remainders of rows into one column. Without whole columns, the remainders
  /// stay a leaf of their own.
  void endColumns();
  void addGathered(StateColumns& columns, std::int64_t count);
  void foldInOrder(std::int64_t x, std::int64_t count);
  /// The number of leaves that may be folded side by side, a power of 2; 0 if that gains nothing.
  std::int64_t leavesTogether(std::int64_t count) const;
  /// Folds consecutive leaves side by side. They are combined as if folded one by one, neighbours first:
  /// therefore columns of leaves whose numbers differ in the lowest bit are placed half of the columns apart.
  void foldLeaves(std::int64_t x, std::int64_t count);
  void endLeaf();

  const FoldProgram& program_;
  const BlockPieces& pieces_;
  CallMemory memory_;
  std::int64_t side_;
  LeafFolder leaves_;
  ColumnCombiner combiner_;
  StateRuns runs_;  ///< of single columns
  StateRuns columnRuns_;
  StateColumns rest_;  ///< remainders of rows
  std::int64_t restUsed_ = 0;
  /// Elements so far of the current leaf, in order; or, in any order, of the remainders' leaf in each column.
  std::int64_t folded_ = 0;
  static constexpr std::int64_t mostLeaves = 16;  ///< most leaves that one call folds, in any order
  std::int64_t group_;  ///< most columns of leaves that are folded together
  StateColumns leafColumns_, orderedColumns_;
};

}  // namespace sk
