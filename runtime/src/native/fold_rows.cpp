// SPDX-License-Identifier: MIT
#include "native/fold_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "native/piece_folder.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

namespace {

using native::Deal;
using native::Range;

Deal dealOfRows(const FoldProgram& program) { return program.isUneven ? Deal::AsTheyCome : Deal::Evenly; }

/// Folds consecutive rows or pieces to columns. Each thread has its own.
class RunFolder {
 public:
  explicit RunFolder(const RowsProgram& program)
      : program_(program),
        arrays_(program.fold.layout, mostStaged, mostStaged),
        mustStage_(!program.fold.layout.isDirect() || program.fold.layout.hasGathers()),
        columns_(program.fold.shape, RowPieces::groupPieces) {
    arrays_.moveTo({});
    chunk_.arrays = arrays_.get();
    chunk_.step = 1;
  }

  /// Calls visit(first, columns, count) with the results of runs `first` to `first + count - 1` in the first columns,
  /// for all runs of the range. Run i has the elements starts[i] to starts[i + 1] - 1; at most mostStaged if elements
  /// are laid out.
  template <class Visit>
  void fold(const std::int32_t* starts, Range range, Visit&& visit) {
    for (std::int64_t end = 0; range.begin < range.end; range.begin = end) {
      end = std::min(range.end, range.begin + RowPieces::groupPieces);
      while (mustStage_ && end - range.begin > 1 && starts[end] - starts[range.begin] > mostStaged) --end;
      const std::int64_t first = starts[range.begin], count = starts[end] - first;
      if (count > 0) arrays_.place(first, count, count);
      chunk_.first[0] = first;
      chunk_.count = count;
      program_.rows.function(program_.rows.frame, &chunk_, starts + range.begin, columns_.arrays(),
                             end - range.begin);
      visit(range.begin, columns_, end - range.begin);
    }
  }
  bool mustStage() const { return mustStage_; }

 private:
  const RowsProgram& program_;
  SlotArrays arrays_;
  bool mustStage_;
  StateColumns columns_;
  native::Chunk chunk_{};
};

/// Folds rows of one piece by groups, and long rows by batches of pieces, which several threads may fold.
class RowFold {
 public:
  RowFold(const RowsProgram& program, const RowPieces& pieces, const FoldResults& results)
      : program_(program), pieces_(pieces), results_(results), bytes_(program.fold.shape.bytes()) {
    for (const RowPieces::LongRow& row : pieces.longRows()) {
      firstBatches_.push_back(static_cast<std::int64_t>(batches_.size()));
      for (std::int32_t first = 0; first < row.pieces; first += ofBatch)
        batches_.push_back(
            {row.row, row.firstPiece + first, std::min(ofBatch, row.pieces - first), row.pieces <= ofBatch});
    }
    firstBatches_.push_back(static_cast<std::int64_t>(batches_.size()));
    states_.resize(batches_.size() * bytes_);
  }

  void run() {
    const std::span<const RowPieces::Group> groups = pieces_.groups();
    const Deal deal = batches_.empty() ? dealOfRows(program_.fold) : Deal::AsTheyCome;
    native::inParallel(static_cast<std::int64_t>(groups.size()), RowPieces::groupElements, deal,
                       [&](Range range) {
                         RunFolder folder(program_);
                         for (std::int64_t i = range.begin; i < range.end; ++i) {
                           const RowPieces::Group& group = groups[static_cast<std::size_t>(i)];
                           foldShortRows(folder, {group.firstPiece, group.firstPiece + group.pieces});
                         }
                       });
    native::inParallel(static_cast<std::int64_t>(batches_.size()), ofBatch * program::longestRun,
                       Deal::AsTheyCome, [&](Range range) {
                         BatchFolder folder(program_);
                         for (std::int64_t i = range.begin; i < range.end; ++i) foldBatch(folder, i);
                       });
    native::inParallel(static_cast<std::int64_t>(pieces_.longRows().size()), ofBatch, Deal::AsTheyCome,
                       [&](Range range) { combineRows(range); });
  }

 private:
  /// The pieces of a batch, a power of 2.
  static constexpr std::int32_t ofBatch = 64;

  struct Batch {
    std::int32_t row, firstPiece, pieces;
    bool isWhole;  ///< a whole row
  };

  std::byte* stateOf(std::int64_t batch) { return states_.data() + static_cast<std::size_t>(batch) * bytes_; }
  static std::int64_t endOf(const RowPieces::LongRow& row) { return row.firstPiece + row.pieces; }

  /// Folds those of the pieces that are whole rows.
  void foldShortRows(RunFolder& folder, Range range) {
    const std::int32_t* const starts = pieces_.pieceStarts().data();
    const std::span<const RowPieces::LongRow> rows = pieces_.longRows();
    auto next =
        static_cast<std::size_t>(std::ranges::upper_bound(rows, range.begin, {}, endOf) - rows.begin());
    while (range.begin < range.end) {
      const RowPieces::LongRow* const row = next < rows.size() ? &rows[next] : nullptr;
      if (row != nullptr && range.begin >= row->firstPiece) {
        range.begin = endOf(*row);
        ++next;
        continue;
      }
      const std::int64_t end =
          row == nullptr ? range.end : std::min<std::int64_t>(range.end, row->firstPiece);
      // long rows before these have more pieces than rows
      const std::int64_t more = next == 0 ? 0 : endOf(rows[next - 1]) - (rows[next - 1].row + 1);
      folder.fold(starts, {range.begin, end},
                  [&](std::int64_t first, const StateColumns& columns, std::int64_t count) {
                    results_.store({first - more, 0, 0, 0}, columns, count);
                  });
      range.begin = end;
    }
  }

  /// Folds the pieces of batches and combines their results, a tree. Each thread has its own.
  class BatchFolder {
   public:
    explicit BatchFolder(const RowsProgram& program)
        : folder_(program),
          combiner_(combinerOf(program.fold)),
          runs_(program.fold.shape, combiner_, 1),
          columns_(program.fold.shape, ofBatch) {}

    const StateColumns& fold(const std::int32_t* starts, std::int64_t count) {
      for (std::int64_t together = 0; count > 0; count -= together, starts += together) {
        together = powerUpTo(count);
        if (folder_.mustStage()) together = std::min(together, mostStaged / program::longestRun);
        folder_.fold(starts, {0, together}, [&](std::int64_t, const StateColumns& columns, std::int64_t) {
          columns_.assignReversed(columns, together);
        });
        combiner_.gather(columns_, together);
        runs_.next().assign(0, columns_, 0, 1);
        runs_.add(together);
      }
      return runs_.take();
    }

   private:
    RunFolder folder_;
    ColumnCombiner combiner_;
    StateRuns runs_;
    StateColumns columns_;
  };

  void foldBatch(BatchFolder& folder, std::int64_t i) {
    const Batch& batch = batches_[static_cast<std::size_t>(i)];
    const StateColumns& state = folder.fold(pieces_.pieceStarts().data() + batch.firstPiece, batch.pieces);
    if (batch.isWhole) {
      results_.store({batch.row, 0, 0, 0}, state, 1);
    } else {
      state.pack(0, stateOf(i));
    }
  }

  /// Combines the batches of rows that have several.
  void combineRows(Range range) {
    ColumnCombiner combiner = combinerOf(program_.fold);
    StateRuns runs(program_.fold.shape, combiner, 1);
    for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i) {
      if (pieces_.longRows()[i].pieces <= ofBatch) continue;
      for (std::int64_t batch = firstBatches_[i]; batch < firstBatches_[i + 1]; ++batch) {
        runs.next().unpack(0, stateOf(batch));
        runs.add();
      }
      results_.store({pieces_.longRows()[i].row, 0, 0, 0}, runs.take(), 1);
    }
  }

  const RowsProgram& program_;
  const RowPieces& pieces_;
  const FoldResults& results_;
  std::size_t bytes_;  ///< of a state
  std::vector<Batch> batches_;  ///< of all long rows
  std::vector<std::int64_t> firstBatches_;  ///< of each long row, then their number
  std::vector<std::byte> states_;  ///< of batches
};

/// Scans rows in parts. Those of a long row first fold all that is before them.
class RowScan {
 public:
  RowScan(const ScanProgram& program, const RowsProgram& rows, const FoldResults& results)
      : program_(program), rows_(rows), results_(results), bytes_(program.fold.shape.bytes()) {}

  void run(const RowPieces& pieces) {
    findParts(pieces.starts());
    if (carries_ > 0) {
      foldParts();
      combineParts();
    }
    scanParts();
  }

 private:
  /// The elements of a part. Exact sums have no room for more than a run, and their rows are one part.
  static constexpr std::int32_t most = 1 << 12;

  struct Part {
    std::int32_t begin, end;
    std::int64_t carry;  ///< the number of the accumulators of the parts before; -1 if it starts a row
  };

  void findParts(std::span<const std::int32_t> starts) {
    parts_.reserve(starts.size());
    for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
      const std::int32_t end = starts[row + 1];
      const std::int32_t step = program_.combinesRuns ? end - starts[row] : most;
      for (std::int32_t begin = starts[row]; begin < end; begin += std::min(step, end - begin)) {
        const bool isFirst = begin == starts[row];
        parts_.push_back({begin, std::min(end - begin, step) + begin, isFirst ? -1 : carries_++});
      }
    }
    states_.resize(static_cast<std::size_t>(carries_) * bytes_);
  }

  std::byte* carryOf(const Part& part) {
    return states_.data() + static_cast<std::size_t>(part.carry) * bytes_;
  }

  template <class Work>
  void inParallel(Work&& work) const {
    const std::int64_t parts = static_cast<std::int64_t>(parts_.size());
    const std::int64_t cost = parts == 0 ? 1 : (parts_.back().end - parts_.front().begin) / parts + 1;
    native::inParallel(parts, cost, Deal::AsTheyCome, work);
  }

  /// Each part that another one continues, to the carry of that one.
  void foldParts() {
    inParallel([&](Range range) {
      RunFolder folder(rows_);
      ColumnCombiner combiner = combinerOf(program_.fold);
      StateColumns total(program_.fold.shape, 1);
      for (std::int64_t i = range.begin; i < range.end; ++i) {
        const auto next = static_cast<std::size_t>(i) + 1;
        if (next == parts_.size() || parts_[next].carry < 0) continue;
        const Part& part = parts_[next - 1];
        for (std::int32_t begin = part.begin; begin < part.end; begin += mostStaged) {
          const std::int32_t starts[] = {begin, std::min<std::int32_t>(part.end, begin + mostStaged)};
          folder.fold(starts, {0, 1}, [&](std::int64_t, const StateColumns& columns, std::int64_t) {
            if (begin == part.begin) {
              total.assign(0, columns, 0, 1);
            } else {
              combiner.combine(total, columns, 0, 1);
            }
          });
        }
        total.pack(0, carryOf(parts_[next]));
      }
    });
  }

  /// Combines each carry with those before it in its row.
  void combineParts() {
    ColumnCombiner combiner = combinerOf(program_.fold);
    StateColumns before(program_.fold.shape, 1), part(program_.fold.shape, 1);
    for (std::size_t i = 1; i < parts_.size(); ++i) {
      if (parts_[i].carry < 0) continue;
      part.unpack(0, carryOf(parts_[i]));
      if (parts_[i - 1].carry < 0) {
        before.assign(0, part, 0, 1);
      } else {
        combiner.combine(before, part, 0, 1);
        before.pack(0, carryOf(parts_[i]));
      }
    }
  }

  void scanParts() {
    inParallel([&](Range range) {
      RowScanner scanner(program_, results_);
      StateColumns state(program_.fold.shape, 1);
      for (std::int64_t i = range.begin; i < range.end; ++i) {
        const Part& part = parts_[static_cast<std::size_t>(i)];
        if (part.carry >= 0) state.unpack(0, carryOf(part));
        scanner.scan(state, {part.begin, 0, 0, 0}, part.end - part.begin,
                     part.carry < 0 ? Start::New : Start::Continued);
      }
    });
  }

  const ScanProgram& program_;
  const RowsProgram& rows_;
  const FoldResults& results_;
  std::size_t bytes_;  ///< of a state
  std::vector<Part> parts_;
  std::int64_t carries_ = 0;
  std::vector<std::byte> states_;
};

}  // namespace

void foldRows(const RowsProgram& program, const RowPieces& pieces, const FoldResults& results) {
  RowFold(program, pieces, results).run();
}

void scanRows(const ScanProgram& program, const RowsProgram& rows, const RowPieces& pieces,
              const FoldResults& results) {
  RowScan(program, rows, results).run(pieces);
}

}  // namespace sk
