// SPDX-License-Identifier: MIT
//
// The loops around reductions. A block of the domain is divided into pieces, which are folded by themselves
// and then combined in order; narrow blocks are folded side by side.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "native/fold_pieces.hpp"
#include "native/fold_program.hpp"
#include "native/memory.hpp"
#include "native/per_worker.hpp"
#include "native/piece_folder.hpp"
#include "native/whole_pieces.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

namespace {

using native::Deal;
using native::Extents;
using native::Range;

/// Folds groups of narrow blocks.
class GroupFolder {
 public:
  GroupFolder(const FoldProgram& program, const Extents& block)
      : block_(block),
        first_(program.first),
        leaves_(program, memory_.get()),
        combiner_(combinerOf(program, memory_.get())),
        runs_(program.shape, combiner_, groupOf(program.shape), memory_.get()) {}

  /// Folds these rows of `count` neighbouring blocks from `first` on, one per column.
  const StateColumns& fold(const Extents& first, std::int64_t count, Range rows) {
    runs_.useColumns(count);
    Extents in{0, rows.begin % block_[1], rows.begin / block_[1] % block_[2],
               rows.begin / block_[1] / block_[2]};
    for (std::int64_t row = rows.begin; row < rows.end; ++row) {
      foldRow(first, in, count);
      for (std::size_t d = 1; d < 4 && ++in[d] == block_[d]; ++d) in[d] = 0;
    }
    if (rounds_ > 0) endLeaf();
    return runs_.take();
  }

 private:
  void foldRow(const Extents& block, const Extents& in, std::int64_t count) {
    Extents first;
    for (std::size_t d = 0; d < 4; ++d) first[d] = first_[d] + block[d] * block_[d] + in[d];
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

  Extents block_, first_;
  CallMemory memory_;
  LeafFolder leaves_;
  ColumnCombiner combiner_;
  StateRuns runs_;
  std::int64_t rounds_ = 0;  ///< elements of the current leaf so far, in each column
};

/// Larger accumulators gain little if blocks are folded side by side.
constexpr std::size_t mostInGroups = 8;

/// Divides the rows of blocks into pieces of whole leaves, a power of 2 of them, and fewer at the end. Combined in order, they give
/// the tree of all leaves, so that results do not depend on the pieces.
class LeafPieces {
 public:
  LeafPieces(const Extents& block, std::int64_t columns)
      : rows_(block[1] * block[2] * block[3]), ofLeaf_(std::max<std::int64_t>(leafRounds / block[0], 1)) {
    constexpr std::uint64_t elements = 1 << 15;  // of a piece: some tens of microseconds
    const auto ofPiece = elements / static_cast<std::uint64_t>(columns * leafRounds);
    const auto most = static_cast<std::int64_t>(std::bit_floor(std::max<std::uint64_t>(ofPiece, 1)));
    const bool areWhole = leafRounds % block[0] == 0;
    for (std::int64_t left = (rows_ + ofLeaf_ - 1) / ofLeaf_; left > 0 && areWhole; left -= leaves_.back())
      leaves_.push_back(
          std::min(most, static_cast<std::int64_t>(std::bit_floor(static_cast<std::uint64_t>(left)))));
    if (!areWhole) leaves_.push_back(0);
    first_.push_back(0);
    for (const std::int64_t leaves : leaves_) first_.push_back(first_.back() + leaves * ofLeaf_);
    first_.back() = rows_;
  }

  std::int64_t count() const { return static_cast<std::int64_t>(leaves_.size()); }
  std::int64_t leavesOf(std::int64_t piece) const { return leaves_[static_cast<std::size_t>(piece)]; }
  Range rowsOf(std::int64_t piece) const {
    const auto number = static_cast<std::size_t>(piece);
    return {first_[number], first_[number + 1]};
  }
  std::int64_t rows() const { return rows_; }

 private:
  std::int64_t rows_, ofLeaf_;  ///< of a block, and of a leaf
  std::vector<std::int64_t> leaves_, first_;  ///< of each piece; and its first row, and the end
};

/// Folds pieces of each group, which all threads take, where there are too few groups for them.
void foldPiecesOfGroups(const FoldProgram& program, const Extents& block, const BlockGroups& groups,
                        const LeafPieces& pieces, Deal deal, const FoldResults& results) {
  const std::size_t bytes = program.shape.bytes();
  const std::int64_t longest = groups.lengthFrom({});
  std::vector<std::byte> states(static_cast<std::size_t>(groups.count() * pieces.count() * longest) * bytes);
  const auto stateOf = [&](std::int64_t piece, std::int64_t column) {
    return states.data() + static_cast<std::size_t>(piece * longest + column) * bytes;
  };
  native::inParallel(
      groups.count() * pieces.count(), groups.elementsOfOne() / pieces.count(), deal, [&](Range range) {
        GroupFolder folder(program, block);
        for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
          const Extents first = groups.firstOf(piece / pieces.count());
          const std::int64_t count = groups.lengthFrom(first);
          const StateColumns& state = folder.fold(first, count, pieces.rowsOf(piece % pieces.count()));
          for (std::int64_t k = 0; k < count; ++k) state.pack(k, stateOf(piece, k));
        }
      });
  CallMemory memory;
  ColumnCombiner combiner = combinerOf(program, memory.get());
  StateRuns runs(program.shape, combiner, groupOf(program.shape), memory.get());
  for (std::int64_t group = 0; group < groups.count(); ++group) {
    const Extents first = groups.firstOf(group);
    const std::int64_t count = groups.lengthFrom(first);
    runs.useColumns(count);
    for (std::int64_t piece = 0; piece < pieces.count(); ++piece) {
      for (std::int64_t k = 0; k < count; ++k)
        runs.next().unpack(k, stateOf(group * pieces.count() + piece, k));
      runs.add(pieces.leavesOf(piece));
    }
    results.store(first, runs.take(), count);
  }
}

void foldGroups(const FoldProgram& program, const Extents& domain, const Extents& block, Deal deal,
                const FoldResults& results) {
  const BlockGroups groups(domain, block, BlockGroups::sideBySide(domain, block, groupOf(program.shape)));
  const LeafPieces pieces(block, groups.lengthFrom({}));
  const std::int64_t threads = native::threadsFor(
      groups.count() * pieces.count(), std::max<std::int64_t>(groups.elementsOfOne() / pieces.count(), 1));
  if (pieces.count() > 1 && groups.count() < threads)
    return foldPiecesOfGroups(program, block, groups, pieces, deal, results);
  native::inParallel(groups.count(), groups.elementsOfOne(), deal, [&](Range range) {
    GroupFolder folder(program, block);
    for (std::int64_t group = range.begin; group < range.end; ++group) {
      const Extents first = groups.firstOf(group);
      const std::int64_t count = groups.lengthFrom(first);
      results.store(first, folder.fold(first, count, {0, pieces.rows()}), count);
    }
  });
}

/// Combines the partial results of each block's pieces, in order.
void combinePieces(const FoldProgram& program, const BlockPieces& pieces,
                   const std::vector<std::byte>& states, const FoldResults& results) {
  CallMemory memory;
  ColumnCombiner combiner = combinerOf(program, memory.get());
  StateRuns runs(program.shape, combiner, 1, memory.get());
  StateColumns columns(program.shape, groupOf(program.shape), memory.get());
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
      const std::size_t bytes = shape.bytesOf(arrays_.size());
      const bool isRounded = operands[i].holdsFloats && bytes == sizeof(double);
      arrays_.push_back(
          {static_cast<std::byte*>(array), &operands[i], isRounded ? sizeof(float) : bytes, isRounded});
    }
  }
}

void FoldResults::store(const Extents& block, const StateColumns& columns, std::int64_t count,
                        std::int64_t from) const {
  for (std::size_t scalar = 0; scalar < arrays_.size(); ++scalar) {
    const Array& array = arrays_[scalar];
    if (array.array == nullptr) continue;
    const std::int64_t step = array.operand->stride[0];
    const std::size_t together = step == 1 ? static_cast<std::size_t>(count) : 1;
    std::byte* to = at(scalar, block);
    if (array.isRounded) {
      const auto* const doubles = reinterpret_cast<const double*>(columns.at(scalar, from));
      auto* const floats = reinterpret_cast<float*>(to);
      for (std::int64_t k = 0; k < count; ++k) floats[k * step] = static_cast<float>(doubles[k]);
      continue;
    }
    for (std::int64_t k = 0; k < count; k += static_cast<std::int64_t>(together)) {
      std::memcpy(to, columns.at(scalar, from + k), together * array.bytes);
      to += step * static_cast<std::int64_t>(array.bytes);
    }
  }
}

bool FoldResults::areRows() const {
  return std::ranges::all_of(arrays_, [](const Array& array) {
    return array.array != nullptr && array.operand->stride[0] == 1 && !array.isRounded;
  });
}

bool FoldResults::areRoundedRows() const {
  return std::ranges::all_of(arrays_, [](const Array& array) {
    return array.array != nullptr && array.operand->stride[0] == 1 && array.isRounded;
  });
}

std::byte* FoldResults::at(std::size_t scalar, const Extents& block) const {
  const Array& array = arrays_[scalar];
  std::int64_t number = array.operand->first;
  for (std::size_t d = 0; d < 4; ++d) number += block[d] * array.operand->stride[d];
  return array.array + number * static_cast<std::int64_t>(array.bytes);
}

void foldBlocks(const FoldProgram& program, const Extents& domain, const Extents& block,
                const FoldResults& results) {
  const Deal deal = program.isUneven ? Deal::AsTheyCome : Deal::Evenly;
  if (program.shape.scalars() <= mostInGroups && BlockGroups::areNarrow(domain, block)) {
    foldGroups(program, domain, block, deal, results);
    return;
  }
  const BlockPieces pieces(domain, block, program.first);
  const std::int64_t ofBlock = pieces.ofBlock();
  const std::size_t bytes = program.shape.bytes();
  std::vector<std::byte> states(ofBlock == 1 ? 0 : static_cast<std::size_t>(pieces.count()) * bytes);
  const std::optional<WholePieces> whole = ofBlock == 1 ? std::nullopt : WholePieces::of(program, pieces);
  PerWorker<PieceFolder> folders(native::threadsFor(pieces.count(), pieces.elementsOfOne()));
  native::inParallel(pieces.count(), pieces.elementsOfOne(), deal, [&](Range range, int worker) {
    for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
      if (whole && piece < whole->count()) {
        whole->fold(piece, states.data() + static_cast<std::size_t>(piece) * bytes);
        continue;
      }
      PieceFolder& folder = folders.of(worker, program, pieces);
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
