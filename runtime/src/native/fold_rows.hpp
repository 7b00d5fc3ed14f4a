// SPDX-License-Identifier: MIT
//
// Reductions and scans of rows of different lengths. Threads share pieces of rows, so that it does not matter how long
// these are; pieces do not depend on the number of threads, and so neither do the results.
#pragma once

#include "call/row_pieces.hpp"
#include "native/fold_program.hpp"
#include "native/scan_blocks.hpp"
#include "sk/native/code.hpp"

namespace sk {

struct RowsProgram {
  const FoldProgram& fold;
  Bound<native::FoldRowsFunction> rows;
};

/// Folds each row of a one-dimensional domain to one element of the results.
void foldRows(const RowsProgram& program, const RowPieces& pieces, const FoldResults& results);

/// Scans each row of a one-dimensional domain on its own. Together, the rows are the domain.
void scanRows(const ScanProgram& program, const RowsProgram& rows, const RowPieces& pieces,
              const FoldResults& results);

}  // namespace sk
