// SPDX-License-Identifier: MIT
//
// The parser of files in the Matrix Market format, which sk/sparse_matrix.hpp reads.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sparse.hpp"

namespace sk::linear {

struct MarketFile {
  SparseMatrix matrix;
  /// Entries that the text has several times, which were added up.
  std::int64_t duplicates = 0;
};

/// What readMatrixMarket() reads from a file, from memory; `name` stands for the file in messages.
MarketFile parseMarket(std::string_view text, const std::string& name);

}  // namespace sk::linear
