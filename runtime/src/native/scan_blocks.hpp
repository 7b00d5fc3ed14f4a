// SPDX-License-Identifier: MIT
//
// The loops around scans: folds that store the accumulators of each element. Long lines are divided into pieces, which
// do not depend on the number of threads: they are folded by themselves, and then scanned from the combined results of
// the pieces before them. Lines across rows are scanned side by side. A RowScanner scans neighbours in a row with one call
// of a scan's object code, or with several if it cannot take them in one.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "native/fold_program.hpp"
#include "native/piece_folder.hpp"

namespace sk {

struct ScanProgram {
  FoldProgram fold;
  Bound<native::ScanFunction> scan;
  native::ValuesFunction* identities;  ///< null if neither an exclusive scan nor `combinesRuns` needs them
  bool isExclusive;
  bool combinesRuns;  ///< see native::ScanOf
  bool storesFloats;  ///< `scan` rounds doubles to floats: results are FoldResults::areRoundedRows()
};

/// Identities side by side.
StateColumns identitiesOf(const ScanProgram& program, std::int64_t count);

/// Scans each block of a domain, which is a line along one dimension or the whole domain. `results` has an element for
/// each of the domain.
void scanBlocks(const ScanProgram& program, const native::Extents& domain, const native::Extents& block,
                const FoldResults& results);

/// Combines accumulators with identities after each run of elements.
class RunCombiner {
  /// The first run may continue from a leaf that was not combined.
  static_assert(program::DigitLoad<std::int32_t>(leafRounds).room() >= leafRounds);

 public:
  RunCombiner(const ScanProgram& program, std::int64_t columns)
      : combiner_(combinerOf(program.fold)), identities_(identitiesOf(program, columns)) {}

  /// The elements that may be folded until the next end of a run.
  std::int64_t left() const { return leafRounds - folded_; }
  /// `count` elements were folded into each of these columns.
  void add(std::int64_t count, StateColumns& state, std::int64_t columns) {
    folded_ += count;
    if (folded_ < leafRounds) return;
    combiner_.combine(state, identities_, 0, columns);
    folded_ = 0;
  }

 private:
  ColumnCombiner combiner_;
  StateColumns identities_;
  std::int64_t folded_ = 0;
};

/// Each thread has its own.
class RowScanner {
 public:
  RowScanner(const ScanProgram& program, const FoldResults& results);

  /// Scans `count` elements from this one on, and leaves the accumulators in the first column of `state`.
  void scan(StateColumns& state, native::Extents first, std::int64_t count, Start start);

 private:
  const ScanProgram& program_;
  const FoldResults& results_;
  bool areRows_;  ///< results are stored in place
  std::int64_t longest_;  ///< most elements of a call
  SlotArrays arrays_;
  StateColumns scratch_;
  std::vector<void*> rows_;
  std::optional<RunCombiner> runs_;
  native::Chunk chunk_{};
};

}  // namespace sk
