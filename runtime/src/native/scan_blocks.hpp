// SPDX-License-Identifier: MIT
//
// The loops around scans: folds that store the accumulators of each element. Long lines are divided into pieces, which
// do not depend on the number of threads: they are folded by themselves, and then scanned from the combined results of
// the pieces before them. Lines across rows are scanned side by side.
#pragma once

#include "native/fold_program.hpp"

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

}  // namespace sk
