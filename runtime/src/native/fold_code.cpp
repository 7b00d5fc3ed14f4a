// SPDX-License-Identifier: MIT
#include "native/fold_code.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "call/check_written.hpp"
#include "call/row_pieces.hpp"
#include "native/check_fold.hpp"
#include "native/components.hpp"
#include "native/fold_program.hpp"
#include "native/memory.hpp"
#include "native/piece_folder.hpp"
#include "native/scan_blocks.hpp"
#include "native/sum_floats.hpp"
#include "sk/native/code.hpp"
#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

// Reductions and scans of rows of different lengths. Threads share pieces of rows, so that it does not matter how long
// these are; pieces do not depend on the number of threads, and so neither do the results.

struct RowsProgram {
  const FoldProgram& fold;
  Bound<native::FoldRowsFunction> rows;
};

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

 private:
  const RowsProgram& program_;
  SlotArrays arrays_;
  bool mustStage_;
  StateColumns columns_;
  native::Chunk chunk_{};
};

/// Folds all pieces by groups, then combines those of long rows: in each batch as a tree, batches of equally many pieces
/// side by side.
class RowFold {
 public:
  RowFold(const RowsProgram& program, const RowPieces& pieces, const FoldResults& results)
      : program_(program), pieces_(pieces), results_(results), bytes_(program.fold.shape.bytes()) {
    const std::span<const RowPieces::LongRow> rows = pieces.longRows();
    const std::size_t states = rows.empty() ? 0 : firstStateOf(rows.size() - 1) + rows.back().pieces;
    states_ = std::make_unique_for_overwrite<std::byte[]>(states * bytes_);
    batchStates_ = std::make_unique_for_overwrite<std::byte[]>(pieces.batches().size() * bytes_);
    std::int32_t firstBatch = 0;
    for (const RowPieces::LongRow& row : rows) {
      const std::int32_t batches = (row.pieces - 1) / RowPieces::batchPieces + 1;
      if (batches > 1) parted_.push_back({row.row, firstBatch, batches});
      firstBatch += batches;
    }
  }

  void run() {
    const std::span<const RowPieces::Group> groups = pieces_.groups();
    const Deal deal = pieces_.longRows().empty() ? dealOfRows(program_.fold) : Deal::AsTheyCome;
    native::inParallel(static_cast<std::int64_t>(groups.size()), RowPieces::groupElements, deal,
                       [&](Range range) {
                         RunFolder folder(program_);
                         for (std::int64_t i = range.begin; i < range.end; ++i)
                           foldGroup(folder, groups[static_cast<std::size_t>(i)]);
                       });
    const auto batches = static_cast<std::int64_t>(pieces_.batches().size());
    native::inParallel((batches + together - 1) / together, together * 16, Deal::AsTheyCome,
                       [&](Range range) {
                         const std::int64_t end = std::min(range.end * together, batches);
                         combineBatches({range.begin * together, end});
                       });
    native::inParallel(static_cast<std::int64_t>(parted_.size()), RowPieces::batchPieces, Deal::AsTheyCome,
                       [&](Range parted) { combineRows(parted); });
  }

 private:
  /// The most batches that are combined side by side.
  static constexpr std::int64_t together = 64;

  struct PartedRow {
    std::int32_t row, firstBatch, batches;
  };

  static std::int64_t endOf(const RowPieces::LongRow& row) { return row.firstPiece + row.pieces; }

  /// The number of the first piece of a long row among those of all long rows: pieces before it less rows of one piece.
  std::size_t firstStateOf(std::size_t longRow) const {
    const RowPieces::LongRow& row = pieces_.longRows()[longRow];
    return static_cast<std::size_t>(row.firstPiece - row.row) + longRow;
  }
  std::byte* stateOf(std::size_t longRow, std::int64_t piece) const {
    const std::int64_t inRow = piece - pieces_.longRows()[longRow].firstPiece;
    return states_.get() + (firstStateOf(longRow) + static_cast<std::size_t>(inRow)) * bytes_;
  }
  std::byte* stateOf(const RowPieces::Batch& batch) const {
    return batchStates_.get() + static_cast<std::size_t>(batch.number) * bytes_;
  }

  /// Stores the results of rows of one piece, and keeps those of other pieces.
  void foldGroup(RunFolder& folder, const RowPieces::Group& group) {
    const std::span<const RowPieces::LongRow> rows = pieces_.longRows();
    auto next =
        static_cast<std::size_t>(std::ranges::upper_bound(rows, group.firstPiece, {}, endOf) - rows.begin());
    folder.fold(pieces_.pieceStarts().data(), {group.firstPiece, group.firstPiece + group.pieces},
                [&](std::int64_t first, const StateColumns& columns, std::int64_t count) {
                  for (std::int64_t piece = first, end = 0; piece < first + count; piece = end) {
                    const RowPieces::LongRow* const row = next < rows.size() ? &rows[next] : nullptr;
                    if (row == nullptr || piece < row->firstPiece) {
                      end = first + count;
                      if (row != nullptr) end = std::min<std::int64_t>(end, row->firstPiece);
                      // long rows before these have more pieces than rows
                      const std::int64_t more =
                          next == 0 ? 0 : endOf(rows[next - 1]) - (rows[next - 1].row + 1);
                      results_.store({piece - more, 0, 0, 0}, columns, end - piece, piece - first);
                      continue;
                    }
                    end = std::min(endOf(*row), first + count);
                    for (std::int64_t i = piece; i < end; ++i) columns.pack(i - first, stateOf(next, i));
                    if (end == endOf(*row)) ++next;
                  }
                });
  }

  void combineBatches(Range range) {
    const std::span<const RowPieces::Batch> batches = pieces_.batches();
    ColumnCombiner combiner = combinerOf(program_.fold);
    StateRuns runs(program_.fold.shape, combiner, together);
    for (std::int64_t end = 0; range.begin < range.end; range.begin = end) {
      const std::int32_t pieces = batches[static_cast<std::size_t>(range.begin)].pieces;
      for (end = range.begin + 1; end < std::min(range.end, range.begin + together) &&
                                  batches[static_cast<std::size_t>(end)].pieces == pieces;)
        ++end;
      combineAlike(runs, batches.subspan(static_cast<std::size_t>(range.begin),
                                         static_cast<std::size_t>(end - range.begin)));
    }
  }

  /// Combines batches of equally many pieces.
  void combineAlike(StateRuns& runs, std::span<const RowPieces::Batch> batches) {
    const auto count = static_cast<std::int64_t>(batches.size());
    runs.useColumns(count);
    for (std::int32_t piece = 0; piece < batches.front().pieces; ++piece) {
      StateColumns& next = runs.next();
      for (std::int64_t i = 0; i < count; ++i) {
        const RowPieces::Batch& batch = batches[static_cast<std::size_t>(i)];
        next.unpack(i, stateOf(static_cast<std::size_t>(batch.longRow), batch.firstPiece + piece));
      }
      runs.add();
    }
    const StateColumns& combined = runs.take();
    for (std::int64_t i = 0; i < count; ++i) {
      const RowPieces::Batch& batch = batches[static_cast<std::size_t>(i)];
      const RowPieces::LongRow& row = pieces_.longRows()[static_cast<std::size_t>(batch.longRow)];
      if (row.pieces <= RowPieces::batchPieces) {
        results_.store({row.row, 0, 0, 0}, combined, 1, i);
      } else {
        combined.pack(i, stateOf(batch));
      }
    }
  }

  /// Combines the batches of rows that have several.
  void combineRows(Range range) {
    ColumnCombiner combiner = combinerOf(program_.fold);
    StateRuns runs(program_.fold.shape, combiner, 1);
    for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i) {
      const std::byte* next = batchStates_.get() + static_cast<std::size_t>(parted_[i].firstBatch) * bytes_;
      for (std::int32_t batch = 0; batch < parted_[i].batches; ++batch, next += bytes_) {
        runs.next().unpack(0, next);
        runs.add();
      }
      results_.store({parted_[i].row, 0, 0, 0}, runs.take(), 1);
    }
  }

  const RowsProgram& program_;
  const RowPieces& pieces_;
  const FoldResults& results_;
  std::size_t bytes_;  ///< of a state
  std::unique_ptr<std::byte[]> states_;  ///< of the pieces of long rows
  std::unique_ptr<std::byte[]> batchStates_;  ///< of batches that are a part of a row
  std::vector<PartedRow> parted_;  ///< rows of several batches
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
    resizeChecked(states_, static_cast<std::size_t>(carries_) * bytes_);
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

/// Folds each row of a one-dimensional domain to one element of the results.
void foldRows(const RowsProgram& program, const RowPieces& pieces, const FoldResults& results) {
  RowFold(program, pieces, results).run();
}

/// Scans each row of a one-dimensional domain on its own. Together, the rows are the domain.
void scanRows(const ScanProgram& program, const RowsProgram& rows, const RowPieces& pieces,
              const FoldResults& results) {
  RowScan(program, rows, results).run(pieces);
}

using native::Entry;
using native::EntryKind;

template <class Function>
Bound<Function> bound(const Entry& entry, const CodeFrame& frame) {
  return {functionOf<Function>(entry), entry.lanes, frame.get()};
}

/// Tries the fold, which must not change any output.
void checkWithoutOutputs(const program::Reduction& reduction, const FoldProgram& program,
                         const native::Call& call, const CodeChoice& choice) {
  if (!program.layout.hasOutputs()) return checkFold(reduction, program, call, choice);
  std::vector<native::Operand> operands(call.operands.begin(), call.operands.end());
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (reduction.fold.parameters[i].role == program::Role::Output) operands[i].components = {};
  }
  const native::Call alone{operands, call.domain, call.tables, call.part};
  const CodeFrame frame(reduction.fold, alone);
  const SlotLayout layout(reduction.fold, alone, frame, choice);
  const FoldProgram tried{.layout = layout,
                          .shape = program.shape,
                          .fold = {program.fold.function, program.fold.lanes, frame.get()},
                          .combine = program.combine,
                          .isCommutative = program.isCommutative,
                          .isUneven = program.isUneven,
                          .first = program.first};
  checkFold(reduction, tried, alone, choice);
}

}  // namespace

void foldCode(const program::Reduction& reduction, const native::ReduceCall& call, const CodeChoice& choice) {
  if (call.rows == nullptr && sumsFloats(reduction, call.fold, choice)) {
    sumFloats(reduction, call, choice);
    return;
  }
  const Entry& fold = entryOf(reduction.fold, EntryKind::Fold, choice);
  const Entry& combine = entryOf(reduction.combine, EntryKind::Combine, choice);
  CallMemory memory;
  const CodeFrame frame(reduction.fold, call.fold, memory.get());
  const CodeFrame combineFrame(reduction.combine, call.combine, memory.get());
  const SlotLayout layout(reduction.fold, call.fold, frame,
                          call.holdsFloats ? CodeChoice{.real = RealType::Float} : choice, memory.get());
  const StateShape shape(reduction.fold.parameters, choice.real);
  const FoldResults results(reduction.fold.parameters, call.fold.operands, shape);
  const FoldProgram program{.layout = layout,
                            .shape = shape,
                            .fold = bound<native::FoldFunction>(fold, frame),
                            .combine = bound<native::CombineFunction>(combine, combineFrame),
                            .isCommutative = reduction.commutative,
                            .isUneven = reduction.fold.code->isUneven != 0,
                            .first = call.fold.computed().first};
  if (checksFolds() && !reduction.commutative) checkWithoutOutputs(reduction, program, call.fold, choice);
  const auto rowsOf = [&] {
    const EntryKind kind = call.holdsFloats ? EntryKind::FoldFloatRows : EntryKind::FoldRows;
    return RowsProgram{program,
                       bound<native::FoldRowsFunction>(entryOf(reduction.fold, kind, choice), frame)};
  };
  if (!call.scan && call.rows != nullptr) {
    foldRows(rowsOf(), *call.rows, results);
    return;
  }
  if (!call.scan) {
    foldBlocks(program, call.fold.computed().extent, call.block, results);
    return;
  }
  native::ValuesFunction* const identities =
      call.scan->isExclusive || call.scan->combinesRuns
          ? functionOf<native::ValuesFunction>(entryOf(reduction.fold, EntryKind::Identity, choice))
          : nullptr;
  const Entry& scan = entryOf(reduction.fold, EntryKind::Scan, choice);
  const ScanProgram scanProgram{program,
                                bound<native::ScanFunction>(scan, frame),
                                identities,
                                call.scan->isExclusive,
                                call.scan->combinesRuns,
                                false};
  if (call.rows != nullptr) {
    scanRows(scanProgram, rowsOf(), *call.rows, results);
    return;
  }
  scanBlocks(scanProgram, call.fold.domain, call.block, results);
}

void combineParts(const program::Reduction& reduction, const native::Call& combine, const CodeChoice& choice,
                  std::span<void* const> parts, std::int64_t count, std::span<void* const> result) {
  const Entry& entry = entryOf(reduction.combine, EntryKind::Combine, choice);
  const CodeFrame frame(reduction.combine, combine);
  const StateShape shape(reduction.fold.parameters, choice.real);
  StateColumns columns(shape, count);
  for (std::size_t scalar = 0; scalar < shape.scalars(); ++scalar) {
    std::memcpy(columns.at(scalar, 0), parts[scalar],
                static_cast<std::size_t>(count) * shape.bytesOf(scalar));
  }
  ColumnCombiner combiner(shape, functionOf<native::CombineFunction>(entry), entry.lanes, frame.get());
  StateRuns runs(shape, combiner, 1);
  for (std::int64_t k = 0; k < count; ++k) {
    runs.next().assign(0, columns, k, 1);
    runs.add();
  }
  const StateColumns& all = runs.take();
  for (std::size_t scalar = 0; scalar < shape.scalars(); ++scalar)
    std::memcpy(result[scalar], all.at(scalar, 0), shape.bytesOf(scalar));
}

void storeIdentities(const program::Reduction& reduction, const native::Call& call,
                     const CodeChoice& choice) {
  const CodeFrame frame(reduction.fold, call);
  const StateShape shape(reduction.fold.parameters, choice.real);
  const StateColumns identities(shape, 1);
  const Entry& entry = entryOf(reduction.fold, EntryKind::Identity, choice);
  functionOf<native::ValuesFunction>(entry)(frame.get(), identities.arrays());
  FoldResults(reduction.fold.parameters, call.operands, shape).store({}, identities, 1);
}

}  // namespace sk
