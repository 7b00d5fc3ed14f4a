// SPDX-License-Identifier: MIT
//
// Files in the Matrix Market format (R. Boisvert, R. Pozo and K. Remington, "The Matrix Market exchange formats", NIST 1996):
// coordinate and array, real, integer and pattern, general, symmetric and skew-symmetric.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sparse.hpp"

namespace linear {

struct MarketFile {
  SparseMatrix matrix;
  /// Entries that the file has several times, which were added up.
  std::int64_t duplicates = 0;
};

/// Reads a matrix. An array is stored like the others, without its zeros. Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong",
/// for a file that is missing, is no Matrix Market file, has entries that are outside, not finite, missing or too many, or is complex.
MarketFile readMarket(const std::filesystem::path& file);
/// The same from memory; `name` stands for the file in messages.
MarketFile parseMarket(std::string_view text, const std::string& name);

/// Reads a vector: a matrix of one column, or of one row. Throws std::runtime_error as readMarket does, or if it is neither.
std::vector<double> readMarketVector(const std::filesystem::path& file);
/// Writes a vector as an array of one column, with all digits. Throws std::runtime_error if the file cannot be written.
void writeMarketVector(const std::filesystem::path& file, std::span<const double> values);

}  // namespace linear
