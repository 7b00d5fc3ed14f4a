// SPDX-License-Identifier: MIT
//
// The loops around reductions. A block of the domain is divided into pieces, which are folded by themselves
// and then combined in order; narrow blocks are folded side by side.
#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "native/fold_pieces.hpp"
#include "native/fold_program.hpp"
#include "native/leaf_folder.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

namespace {

using native::Deal;
using native::Extents;
using native::Range;

/// The largest power of 2 that is not greater than `number`; 0 for 0.
std::int64_t powerUpTo(std::int64_t number) {
  return static_cast<std::int64_t>(std::bit_floor(static_cast<std::uint64_t>(number)));
}

ColumnCombiner combinerOf(const FoldProgram& program) {
  return {program.shape, program.combine.function, program.combine.lanes, program.combine.frame};
}

/// Folds pieces of blocks, one after the other.
class PieceFolder {
 public:
  PieceFolder(const FoldProgram& program, const BlockPieces& pieces)
      : program_(program),
        pieces_(pieces),
        side_(sideOf(program.shape)),
        leaves_(program),
        combiner_(combinerOf(program)),
        runs_(program.shape, combiner_, 1),
        columnRuns_(program.shape, combiner_, side_),
        rest_(program.shape, side_),
        group_(program.isCommutative ? mostLeaves * side_ : groupOf(program.shape)),
        leafColumns_(program.shape, group_),
        orderedColumns_(program.shape, program.isCommutative ? 0 : group_) {}

  /// Folds a piece of a block, which has at least one element, to one column.
  const StateColumns& fold(const Extents& block, std::int64_t piece) {
    pieces_.forEachRow(block, piece, [&](const Extents& first, std::int64_t count) {
      leaves_.moveToRow(first);
      const std::int64_t end = first[0] + count;
      if (!program_.isCommutative) return foldInOrder(first[0], count);
      for (std::int64_t x = first[0]; x < end;) {
        const std::int64_t now = std::min(end - x, leaves_.longest());
        foldColumns(x, now);
        x += now;
      }
    });
    if (program_.isCommutative) endColumns();
    if (folded_ > 0) endLeaf();
    return runs_.take();
  }

 private:
  // ---- in any order: consecutive elements go to consecutive columns --------------------------------

  void foldColumns(std::int64_t x, std::int64_t count) {
    while (count >= side_) {
      const std::int64_t leaves = wholeLeaves(count);
      if (leaves > 1) {
        foldWholeLeaves(x, leaves);
        x += leaves * leafRounds * side_;
        count -= leaves * leafRounds * side_;
        continue;
      }
      const std::int64_t rounds = std::min(count / side_, leafRounds);
      leaves_.fold(columnRuns_.next(), x, side_, rounds, Start::New);
      columnRuns_.add();
      x += rounds * side_;
      count -= rounds * side_;
    }
    if (count > 0) foldRest(x, count);
  }

  /// The number of leaves of whole columns that one call can fold, a power of 2; 0 or 1 if it cannot fold
  /// several.
  std::int64_t wholeLeaves(std::int64_t count) const {
    if (!leaves_.foldsLeavesTogether(side_)) return 0;
    return powerUpTo(std::min({mostLeaves, columnRuns_.mostTogether(), count / (leafRounds * side_)}));
  }
  /// Combines the columns of the leaves as if these were folded one after the other.
  void foldWholeLeaves(std::int64_t x, std::int64_t leaves) {
    leaves_.foldLeaves(leafColumns_, x, side_, leafRounds, leaves);
    combiner_.gather(leafColumns_, leaves * side_, side_);
    columnRuns_.next().assign(0, leafColumns_, 0, side_);
    columnRuns_.add(leaves);
  }

  /// Folds the remainder of a row: one element for some of the columns. The remainders of several rows form a
  /// leaf.
  void foldRest(std::int64_t x, std::int64_t count) {
    const std::int64_t begun = std::min(count, restUsed_);
    leaves_.foldInto(rest_, 0, x, begun, Start::Continued);
    leaves_.foldInto(rest_, begun, x + begun, count - begun, Start::New);
    restUsed_ = std::max(restUsed_, count);
    if (++folded_ == leafRounds) endLeaf();
  }

  /// Combines whole columns and the remainders of rows into one column. Without whole columns, the remainders
  /// stay a leaf of their own.
  void endColumns() {
    if (columnRuns_.isEmpty()) return;
    StateColumns& columns = columnRuns_.take();
    combiner_.combine(columns, rest_, 0, restUsed_);
    addGathered(columns, side_);
    restUsed_ = folded_ = 0;
  }

  void addGathered(StateColumns& columns, std::int64_t count) {
    combiner_.gather(columns, count);
    runs_.next().assign(0, columns, 0, 1);
    runs_.add();
  }

  // ---- in order ----------------------------------------------------------------------------------

  void foldInOrder(std::int64_t x, std::int64_t count) {
    while (count > 0) {
      const std::int64_t together = leavesTogether(count);
      if (together > 0) {
        foldLeaves(x, together);
        x += together * leafRounds;
        count -= together * leafRounds;
        continue;
      }
      const std::int64_t now = std::min(count, leafRounds - folded_);
      leaves_.fold(runs_.next(), x, 1, now, folded_ == 0 ? Start::New : Start::Continued);
      folded_ += now;
      x += now;
      count -= now;
      if (folded_ == leafRounds) endLeaf();
    }
  }

  /// The number of leaves that may be folded side by side, a power of 2; 0 if that gains nothing.
  std::int64_t leavesTogether(std::int64_t count) const {
    if (folded_ != 0 || !leaves_.foldsApart()) return 0;
    const std::int64_t most = std::min({group_, runs_.mostTogether(), count / leafRounds});
    return most < program_.fold.lanes ? 0 : powerUpTo(most);
  }

  /// Folds consecutive leaves side by side. They are combined as if folded one by one, neighbours first:
  /// therefore columns of leaves whose numbers differ in the lowest bit are placed half of the columns apart.
  void foldLeaves(std::int64_t x, std::int64_t count) {
    for (std::int64_t round = 0; round < leafRounds; ++round) {
      leaves_.fold(leafColumns_, x + round, count, 1, round == 0 ? Start::New : Start::Continued, leafRounds);
    }
    orderedColumns_.assignReversed(leafColumns_, count);
    combiner_.gather(orderedColumns_, count);
    runs_.next().assign(0, orderedColumns_, 0, 1);
    runs_.add(count);
  }

  void endLeaf() {
    folded_ = 0;
    if (program_.isCommutative) {
      addGathered(rest_, restUsed_);
      restUsed_ = 0;
    } else {
      runs_.add();
    }
  }

  const FoldProgram& program_;
  const BlockPieces& pieces_;
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

/// Folds groups of narrow blocks.
class GroupFolder {
 public:
  GroupFolder(const FoldProgram& program, const Extents& block)
      : block_(block),
        leaves_(program),
        combiner_(combinerOf(program)),
        runs_(program.shape, combiner_, groupOf(program.shape)) {}

  /// Folds `count` neighbouring blocks from `first` on, one per column.
  const StateColumns& fold(const Extents& first, std::int64_t count) {
    runs_.useColumns(count);
    Extents in{};
    const std::int64_t rows = block_[1] * block_[2] * block_[3];
    for (std::int64_t row = 0; row < rows; ++row) {
      foldRow(first, in, count);
      for (std::size_t d = 1; d < 4 && ++in[d] == block_[d]; ++d) in[d] = 0;
    }
    if (rounds_ > 0) endLeaf();
    return runs_.take();
  }

 private:
  void foldRow(const Extents& block, const Extents& in, std::int64_t count) {
    Extents first;
    for (std::size_t d = 0; d < 4; ++d) first[d] = block[d] * block_[d] + in[d];
    leaves_.moveToRow(first);
    for (std::int64_t x = 0; x < block_[0]; ++x) {
      leaves_.fold(runs_.next(), first[0] + x, count, 1, rounds_ == 0 ? Start::New : Start::Continued,
                   block_[0]);
      if (++rounds_ == leafRounds) endLeaf();
    }
  }

  void endLeaf() {
    rounds_ = 0;
    runs_.add();
  }

  Extents block_;
  LeafFolder leaves_;
  ColumnCombiner combiner_;
  StateRuns runs_;
  std::int64_t rounds_ = 0;  ///< elements of the current leaf so far, in each column
};

/// Larger accumulators gain little if blocks are folded side by side.
constexpr std::size_t mostInGroups = 8;

void foldGroups(const FoldProgram& program, const Extents& domain, const Extents& block, Deal deal,
                const FoldResults& results) {
  const BlockGroups groups(domain, block, groupOf(program.shape));
  native::inParallel(groups.count(), groups.elementsOfOne(), deal, [&](Range range) {
    GroupFolder folder(program, block);
    for (std::int64_t group = range.begin; group < range.end; ++group) {
      const Extents first = groups.firstOf(group);
      const std::int64_t count = groups.lengthFrom(first);
      results.store(first, folder.fold(first, count), count);
    }
  });
}

/// Combines the partial results of each block's pieces, in order.
void combinePieces(const FoldProgram& program, const BlockPieces& pieces,
                   const std::vector<std::byte>& states, const FoldResults& results) {
  ColumnCombiner combiner = combinerOf(program);
  StateRuns runs(program.shape, combiner, 1);
  StateColumns columns(program.shape, groupOf(program.shape));
  const std::int64_t ofBlock = pieces.ofBlock();
  std::int64_t together = 0;
  for (std::int64_t piece = 0; piece < pieces.count(); piece += together) {
    const std::int64_t left = ofBlock - piece % ofBlock;
    together = powerUpTo(std::min({left, runs.mostTogether(), groupOf(program.shape)}));
    columns.unpackReversed(states.data() + static_cast<std::size_t>(piece) * program.shape.bytes(), together);
    combiner.gather(columns, together);
    runs.next().assign(0, columns, 0, 1);
    runs.add(together);
    if (together == left) results.store(pieces.blockAt(piece / ofBlock), runs.take(), 1);
  }
}

}  // namespace

FoldResults::FoldResults(std::span<const program::Parameter> parameters,
                         std::span<const native::Operand> operands, const StateShape& shape) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].role != program::Role::Accumulator) continue;
    for (std::size_t c = 0; c < scalarsOf(*parameters[i].element); ++c) {
      auto* const array = operands[i].components.empty() ? nullptr : operands[i].components[c];
      arrays_.push_back({static_cast<std::byte*>(array), &operands[i], shape.bytesOf(arrays_.size())});
    }
  }
}

void FoldResults::store(const Extents& block, const StateColumns& columns, std::int64_t count) const {
  for (std::size_t scalar = 0; scalar < arrays_.size(); ++scalar) {
    const Array& array = arrays_[scalar];
    if (array.array == nullptr) continue;
    std::int64_t number = array.operand->first;
    for (std::size_t d = 0; d < 4; ++d) number += block[d] * array.operand->stride[d];
    const std::int64_t step = array.operand->stride[0];
    const std::size_t together = step == 1 ? static_cast<std::size_t>(count) : 1;
    std::byte* to = array.array + number * static_cast<std::int64_t>(array.bytes);
    for (std::int64_t k = 0; k < count; k += static_cast<std::int64_t>(together)) {
      std::memcpy(to, columns.at(scalar, k), together * array.bytes);
      to += step * static_cast<std::int64_t>(array.bytes);
    }
  }
}

void foldBlocks(const FoldProgram& program, const Extents& domain, const Extents& block,
                const FoldResults& results) {
  const Deal deal = program.isUneven ? Deal::AsTheyCome : Deal::Evenly;
  if (program.shape.scalars() <= mostInGroups && BlockGroups::areNarrow(domain, block)) {
    foldGroups(program, domain, block, deal, results);
    return;
  }
  const BlockPieces pieces(domain, block);
  const std::int64_t ofBlock = pieces.ofBlock();
  const std::size_t bytes = program.shape.bytes();
  std::vector<std::byte> states(ofBlock == 1 ? 0 : static_cast<std::size_t>(pieces.count()) * bytes);
  native::inParallel(pieces.count(), pieces.elementsOfOne(), deal, [&](Range range) {
    PieceFolder folder(program, pieces);
    for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
      const Extents at = pieces.blockAt(piece / ofBlock);
      const StateColumns& result = folder.fold(at, piece % ofBlock);
      if (ofBlock == 1) {
        results.store(at, result, 1);
      } else {
        result.pack(0, states.data() + static_cast<std::size_t>(piece) * bytes);
      }
    }
  });
  if (ofBlock > 1) combinePieces(program, pieces, states, results);
}

}  // namespace sk
