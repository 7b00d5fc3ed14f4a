// SPDX-License-Identifier: MIT
#include "native/scan_blocks.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "native/piece_folder.hpp"
#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

using native::Deal;
using native::Extents;
using native::Range;

Deal dealOf(const ScanProgram& program) { return program.fold.isUneven ? Deal::AsTheyCome : Deal::Evenly; }

// ---- lines along rows ------------------------------------------------------------------------------

/// Scans blocks of whole rows, some pieces at a time: these are still in the cache when they are read again.
class PieceScan {
 public:
  PieceScan(const ScanProgram& program, const BlockPieces& pieces, const FoldResults& results)
      : program_(program),
        pieces_(pieces),
        results_(results),
        ofBlock_(pieces.ofBlock()),
        bytes_(program.fold.shape.bytes()),
        combiner_(combinerOf(program.fold)),
        carry_(program.fold.shape, 1),
        later_(program.fold.shape, 1) {}

  void run() {
    const std::int64_t count = pieces_.count();
    const std::int64_t together =
        ofBlock_ == 1 ? count : piecesOfThread * native::threadsFor(count, pieces_.elementsOfOne());
    resizeChecked(states_, ofBlock_ == 1 ? 0 : static_cast<std::size_t>(std::min(together, count)) * bytes_);
    for (std::int64_t begin = 0; begin < count; begin += together) {
      const Range some{begin, std::min(begin + together, count)};
      if (ofBlock_ > 1) {
        inParallel(some, [&](Range range) { fold(range, begin); });
        findCarries(some);
      }
      inParallel(some, [&](Range range) { scan(range, begin); });
    }
  }

 private:
  /// As many as a cache holds; threads wait for each other twice in between.
  static constexpr std::int64_t piecesOfThread = 16;

  template <class Work>
  void inParallel(Range pieces, Work&& work) const {
    native::inParallel(
        pieces.end - pieces.begin, pieces_.elementsOfOne(), dealOf(program_),
        [&](Range range) { work(Range{pieces.begin + range.begin, pieces.begin + range.end}); });
  }

  bool startsBlock(std::int64_t piece) const { return piece % ofBlock_ == 0; }
  bool endsBlock(std::int64_t piece) const { return (piece + 1) % ofBlock_ == 0; }
  std::byte* stateOf(std::int64_t piece, std::int64_t begin) {
    return states_.data() + static_cast<std::size_t>(piece - begin) * bytes_;
  }

  void fold(Range range, std::int64_t begin) {
    PieceFolder folder(program_.fold, pieces_);
    for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
      if (endsBlock(piece)) continue;
      folder.fold(pieces_.blockAt(piece / ofBlock_), piece % ofBlock_).pack(0, stateOf(piece, begin));
    }
  }

  /// Replaces the result of each piece by that of all pieces of its block before it, of which the first has none.
  void findCarries(Range some) {
    for (std::int64_t piece = some.begin; piece < some.end; ++piece) {
      std::byte* const state = stateOf(piece, some.begin);
      if (startsBlock(piece)) {
        carry_.unpack(0, state);
      } else {
        later_.unpack(0, state);
        carry_.pack(0, state);
        if (!endsBlock(piece)) combiner_.combine(carry_, later_, 0, 1);
      }
    }
  }

  void scan(Range range, std::int64_t begin) {
    RowScanner scanner(program_, results_);
    StateColumns state(program_.fold.shape, 1);
    for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
      Start start = startsBlock(piece) ? Start::New : Start::Continued;
      if (start == Start::Continued) state.unpack(0, stateOf(piece, begin));
      pieces_.forEachRow(pieces_.blockAt(piece / ofBlock_), piece % ofBlock_,
                         [&](const Extents& first, std::int64_t count) {
                           scanner.scan(state, first, count, start);
                           start = Start::Continued;
                         });
    }
  }

  const ScanProgram& program_;
  const BlockPieces& pieces_;
  const FoldResults& results_;
  std::int64_t ofBlock_;
  std::size_t bytes_;  ///< of a state
  ColumnCombiner combiner_;
  StateColumns carry_, later_;
  std::vector<std::byte> states_;
};

// ---- lines across rows -----------------------------------------------------------------------------

/// Scans groups of neighbouring lines side by side.
class LineScanner {
 public:
  LineScanner(const ScanProgram& program, const Extents& block, const FoldResults& results)
      : program_(program),
        block_(block),
        results_(results),
        leaves_(program.fold),
        state_(program.fold.shape, groupOf(program.fold.shape)),
        before_(program.fold.shape, groupOf(program.fold.shape)),
        identities_(identitiesOf(program, program.isExclusive ? groupOf(program.fold.shape) : 0)) {
    if (program.combinesRuns) runs_.emplace(program, groupOf(program.fold.shape));
  }

  /// Scans `count` lines from `first` on.
  void scan(const Extents& first, std::int64_t count) {
    if (program_.isExclusive) before_.assign(0, identities_, 0, count);
    Extents at = first;
    for (std::size_t d = 1; d < 4; ++d) at[d] *= block_[d];
    const auto along = static_cast<std::size_t>(std::ranges::max_element(block_) - block_.begin());
    for (std::int64_t i = 0; i < block_[along]; ++i, ++at[along]) {
      leaves_.moveToRow(at);
      leaves_.fold(state_, at[0], count, 1, i == 0 ? Start::New : Start::Continued);
      results_.store(at, program_.isExclusive ? before_ : state_, count);
      if (runs_) runs_->add(1, state_, count);
      if (program_.isExclusive) before_.assign(0, state_, 0, count);
    }
  }

 private:
  const ScanProgram& program_;
  Extents block_;
  const FoldResults& results_;
  LeafFolder leaves_;
  StateColumns state_;
  StateColumns before_;  ///< exclusive scans: the accumulators before an element
  StateColumns identities_;
  std::optional<RunCombiner> runs_;
};

void scanLines(const ScanProgram& program, const Extents& domain, const Extents& block,
               const FoldResults& results) {
  const BlockGroups groups(domain, block,
                           BlockGroups::sideBySide(domain, block, groupOf(program.fold.shape)));
  native::inParallel(groups.count(), groups.elementsOfOne(), dealOf(program), [&](Range range) {
    LineScanner scanner(program, block, results);
    for (std::int64_t group = range.begin; group < range.end; ++group) {
      const Extents first = groups.firstOf(group);
      scanner.scan(first, groups.lengthFrom(first));
    }
  });
}

}  // namespace

StateColumns identitiesOf(const ScanProgram& program, std::int64_t count) {
  StateColumns columns(program.fold.shape, count);
  if (count == 0) return columns;
  StateColumns one(program.fold.shape, 1);
  program.identities(program.fold.fold.frame, one.arrays());
  for (std::int64_t k = 0; k < count; ++k) columns.assign(k, one, 0, 1);
  return columns;
}

void scanBlocks(const ScanProgram& program, const Extents& domain, const Extents& block,
                const FoldResults& results) {
  if (block[0] < domain[0]) {
    scanLines(program, domain, block, results);
    return;
  }
  const BlockPieces pieces(domain, block);
  PieceScan(program, pieces, results).run();
}

namespace {

std::int64_t longestCall(const SlotLayout& layout, bool areRows) {
  if (layout.needsElementwiseCalls()) return 1;
  const bool isInPlace = layout.isDirect() && !layout.hasGathers() && areRows;
  return isInPlace ? std::numeric_limits<std::int64_t>::max() : mostStaged;
}

}  // namespace

RowScanner::RowScanner(const ScanProgram& program, const FoldResults& results)
    : program_(program),
      results_(results),
      areRows_(program.storesFloats || results.areRows()),
      longest_(longestCall(program.fold.layout, areRows_)),
      arrays_(program.fold.layout, mostStaged, mostStaged),
      scratch_(program.fold.shape, areRows_ ? 0 : mostStaged),
      rows_(program.fold.shape.scalars()) {
  chunk_.arrays = arrays_.get();
  chunk_.step = 1;
  if (program.combinesRuns) runs_.emplace(program, 1);
}

void RowScanner::scan(StateColumns& state, native::Extents first, std::int64_t count, Start start) {
  arrays_.moveTo(first);
  for (const std::int64_t end = first[0] + count; first[0] < end; start = Start::Continued) {
    const std::int64_t now = std::min({end - first[0], longest_, runs_ ? runs_->left() : longest_});
    arrays_.place(first[0], now, now);
    for (std::size_t scalar = 0; scalar < rows_.size(); ++scalar)
      rows_[scalar] = areRows_ ? results_.at(scalar, first) : scratch_.at(scalar, 0);
    std::ranges::copy(first, chunk_.first);
    chunk_.count = now;
    program_.scan.function(program_.scan.frame, &chunk_, state.arrays(), rows_.data(),
                           start == Start::New ? 1 : 0, program_.isExclusive ? 1 : 0);
    if (runs_) runs_->add(now, state, 1);
    if (!areRows_) results_.store(first, scratch_, now);
    first[0] += now;
  }
}

}  // namespace sk
