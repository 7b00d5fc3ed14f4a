// SPDX-License-Identifier: MIT
//
// Folds a piece of a block (BlockPieces) in a number of steps that grows with its elements divided by the columns that are
// folded side by side. A LeafFolder folds neighbours in a row into accumulators with one call of a fold's object code, or with
// several if it cannot take them in one.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "native/fold_pieces.hpp"
#include "native/fold_program.hpp"
#include "native/memory.hpp"

namespace sk {

/// Whether a fold starts its columns anew or continues them.
enum class Start : std::uint8_t { New, Continued };

/// Each thread has its own.
class LeafFolder {
 public:
  explicit LeafFolder(const FoldProgram& program,
                      std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Elements are in the row of this one from here on.
  void moveToRow(const native::Extents& first);
  /// The most neighbours that are folded as one row; longer rows are divided.
  std::int64_t longest() const { return longest_; }
  /// True if elements that are not neighbours are folded several at a time.
  bool foldsApart() const { return program_.fold.lanes > 1 && !foldsElementwise(); }

  /// True if one call can fold several consecutive leaves of `columns` columns.
  bool foldsLeavesTogether(std::int64_t columns) const {
    return program_.layout.isDirect() && !foldsElementwise() && columns % program_.fold.lanes == 0;
  }
  /// Folds `leaves` leaves from x on, a power of 2. All columns start anew; FoldFunction says where they are
  /// in `state`.
  void foldLeaves(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds,
                  std::int64_t leaves);

  /// Folds the elements at x, x + step ... into the columns of `state`: `rounds` elements into each column,
  /// every `columns`-th. Changes columns beyond the last.
  void fold(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds, Start start,
            std::int64_t step = 1);
  /// Folds one element into each of `count` columns from number `first` on; changes no other column.
  void foldInto(StateColumns& state, std::int64_t first, std::int64_t x, std::int64_t count, Start start);

 private:
  bool foldsElementwise() const {
    return program_.layout.needsElementwiseCalls() || program_.layout.hasGathers();
  }
  /// How a call of the object code divides its elements.
  struct Division {
    std::int64_t columns, rounds, leaves;
  };
  void call(void* const* state, std::int64_t x, const Division& division, Start start, std::int64_t step);
  void foldOneByOne(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds,
                    Start start, std::int64_t step);

  const FoldProgram& program_;
  std::int64_t longest_;
  SlotArrays arrays_;
  StateColumns some_;
  std::pmr::vector<void*> rest_;
  native::Chunk chunk_{};
};

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
