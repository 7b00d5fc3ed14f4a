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

Deal dealOfRows(const FoldProgram& program) {
  return program.isUneven ? Deal::AsTheyCome : Deal::Evenly;
}

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

/// Folds rows in two steps: pieces by themselves, then the results of those that share a row.
class RowFold {
 public:
  RowFold(const RowsProgram& program, const RowPieces& pieces, const FoldResults& results)
      : program_(program), pieces_(pieces), results_(results), bytes_(program.fold.shape.bytes()) {
    std::int64_t states = 0;
    for (const RowPieces::LongRow& row : pieces.longRows()) {
      firstStates_.push_back(states);
      states += row.pieces;
    }
    states_.resize(static_cast<std::size_t>(states) * bytes_);
  }

  void run() {
    const std::span<const RowPieces::Group> groups = pieces_.groups();
    const auto count = static_cast<std::int64_t>(groups.size());
    native::inParallel(count, RowPieces::groupElements, dealOfRows(program_.fold), [&](Range range) {
      RunFolder folder(program_);
      for (std::int64_t i = range.begin; i < range.end; ++i) {
        const RowPieces::Group& group = groups[static_cast<std::size_t>(i)];
        foldPieces(folder, {group.firstPiece, group.firstPiece + group.pieces});
      }
    });
    combineBatches();
    combineRows();
  }

 private:
  /// The pieces of a row that one thread combines, a power of 2: a tree of batches is the tree of their pieces.
  static constexpr std::int64_t batch = 1024;

  std::byte* stateOf(std::int64_t number) { return states_.data() + static_cast<std::size_t>(number) * bytes_; }
  std::int64_t longRows() const { return static_cast<std::int64_t>(pieces_.longRows().size()); }

  /// Folds a range of pieces. Those of long rows are stored with their states, others are results.
  void foldPieces(RunFolder& folder, Range range) {
    const std::int32_t* const starts = pieces_.pieceStarts().data();
    const std::span<const RowPieces::LongRow> rows = pieces_.longRows();
    auto next = static_cast<std::size_t>(
        std::ranges::lower_bound(rows, range.begin, {},
                                 [](const RowPieces::LongRow& row) -> std::int64_t {
                                   return row.firstPiece + row.pieces - 1;
                                 }) -
        rows.begin());
    while (range.begin < range.end) {
      const RowPieces::LongRow* const row = next < rows.size() ? &rows[next] : nullptr;
      if (row == nullptr || range.begin < row->firstPiece) {
        const std::int64_t end = row == nullptr ? range.end : std::min<std::int64_t>(range.end, row->firstPiece);
        // long rows before these have more pieces than rows
        const std::int64_t more = next == 0 ? 0 : endOf(rows[next - 1]) - (rows[next - 1].row + 1);
        folder.fold(starts, {range.begin, end},
                    [&](std::int64_t first, const StateColumns& columns, std::int64_t count) {
                      results_.store({first - more, 0, 0, 0}, columns, count);
                    });
        range.begin = end;
        continue;
      }
      const std::int64_t end = std::min<std::int64_t>(range.end, endOf(*row));
      const std::int64_t state = firstStates_[next] - row->firstPiece;
      folder.fold(starts, {range.begin, end},
                  [&](std::int64_t first, const StateColumns& columns, std::int64_t count) {
                    for (std::int64_t k = 0; k < count; ++k) columns.pack(k, stateOf(state + first + k));
                  });
      range.begin = end;
      if (end == endOf(*row)) ++next;
    }
  }
  static std::int64_t endOf(const RowPieces::LongRow& row) { return row.firstPiece + row.pieces; }

  /// Combines states that are one after the other, a tree.
  class Combiner {
   public:
    explicit Combiner(const FoldProgram& program)
        : combiner_(combinerOf(program)),
          runs_(program.shape, combiner_, 1),
          columns_(program.shape, groupOf(program.shape)),
          most_(groupOf(program.shape)),
          bytes_(program.shape.bytes()) {}

    void add(const std::byte* states, std::int64_t count) {
      for (std::int64_t together = 0; count > 0; count -= together) {
        together = powerUpTo(std::min({count, runs_.mostTogether(), most_}));
        columns_.unpackReversed(states, together);
        combiner_.gather(columns_, together);
        runs_.next().assign(0, columns_, 0, 1);
        runs_.add(together);
        states += static_cast<std::size_t>(together) * bytes_;
      }
    }
    const StateColumns& take() { return runs_.take(); }

   private:
    ColumnCombiner combiner_;
    StateRuns runs_;
    StateColumns columns_;
    std::int64_t most_;
    std::size_t bytes_;
  };

  /// Combines the batches of rows that have more than one. The result replaces the first state of each.
  void combineBatches() {
    struct Batch {
      std::int64_t first, count;
    };
    std::vector<Batch> batches;
    for (std::int64_t i = 0; i < longRows(); ++i) {
      const std::int64_t pieces = pieces_.longRows()[static_cast<std::size_t>(i)].pieces;
      for (std::int64_t first = 0; pieces > batch && first < pieces; first += batch)
        batches.push_back({firstStates_[static_cast<std::size_t>(i)] + first, std::min(batch, pieces - first)});
    }
    native::inParallel(static_cast<std::int64_t>(batches.size()), batch, Deal::Evenly, [&](Range range) {
      Combiner combiner(program_.fold);
      for (std::int64_t i = range.begin; i < range.end; ++i) {
        const auto& [first, count] = batches[static_cast<std::size_t>(i)];
        combiner.add(stateOf(first), count);
        combiner.take().pack(0, stateOf(first));
      }
    });
  }

  void combineRows() {
    const std::int64_t rows = longRows();
    const std::int64_t cost = rows == 0 ? 1 : static_cast<std::int64_t>(states_.size() / bytes_) / rows;
    native::inParallel(rows, cost, Deal::Evenly, [&](Range range) {
      Combiner combiner(program_.fold);
      for (std::int64_t i = range.begin; i < range.end; ++i) {
        const RowPieces::LongRow& row = pieces_.longRows()[static_cast<std::size_t>(i)];
        const std::int64_t first = firstStates_[static_cast<std::size_t>(i)];
        if (row.pieces <= batch) {
          combiner.add(stateOf(first), row.pieces);
        } else {
          for (std::int64_t k = 0; k < row.pieces; k += batch) combiner.add(stateOf(first + k), 1);
        }
        results_.store({row.row, 0, 0, 0}, combiner.take(), 1);
      }
    });
  }

  const RowsProgram& program_;
  const RowPieces& pieces_;
  const FoldResults& results_;
  std::size_t bytes_;  ///< of a state
  std::vector<std::int64_t> firstStates_;  ///< of each long row
  std::vector<std::byte> states_;  ///< of the pieces of long rows
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

  std::byte* carryOf(const Part& part) { return states_.data() + static_cast<std::size_t>(part.carry) * bytes_; }

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
