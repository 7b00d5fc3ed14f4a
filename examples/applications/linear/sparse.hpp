// SPDX-License-Identifier: MIT
//
// Sparse matrices in host memory, in compressed rows and double precision: what files are read to, what the layouts on a device
// are built from, and what residuals are computed with. It knows no device.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace linear {

/// An entry of a matrix, counted from 0.
struct Entry {
  std::int64_t row = 0;
  std::int64_t column = 0;
  double value = 0.0;
};

/// Row i has the entries starts[i] to starts[i + 1] - 1, in ascending order of their columns, no column twice. Entries may be 0.
struct SparseMatrix {
  std::int64_t rows = 0;
  std::int64_t columns = 0;
  std::vector<std::int64_t> starts{0};  ///< rows + 1
  std::vector<std::int32_t> column;  ///< of each entry
  std::vector<double> value;

  std::int64_t entries() const { return static_cast<std::int64_t>(value.size()); }
  std::int64_t length(std::int64_t row) const {
    return starts[static_cast<std::size_t>(row) + 1] - starts[static_cast<std::size_t>(row)];
  }
};

/// Sorts entries into rows. Entries of one place are added up; `duplicates` counts those that were added to another one. Throws
/// std::runtime_error if an entry is outside of the matrix, or if an extent is negative or 2^31 or more.
SparseMatrix assemble(std::int64_t rows, std::int64_t columns, std::span<const Entry> entries,
                      std::int64_t* duplicates = nullptr);

/// y = A x. The sums are those of double precision, in the order of the columns.
std::vector<double> multiply(const SparseMatrix& a, std::span<const double> x);
/// A B, in double precision, with all entries that the structures of A and B give, also if they add up to 0; std::nullopt as soon as it has more than `most` of them.
std::optional<SparseMatrix> multiply(const SparseMatrix& a, const SparseMatrix& b, std::int64_t most);
SparseMatrix transpose(const SparseMatrix& a);
/// The largest sum of magnitudes of a row.
double infinityNorm(const SparseMatrix& a);
/// The diagonal; 0 where there is no entry.
std::vector<double> diagonal(const SparseMatrix& a);

/// A place where a matrix differs from its transpose, counted from 1 as in files, for messages; "" if it is symmetric.
std::string asymmetry(const SparseMatrix& a);
/// "row 17", counted from 0, of the first row whose diagonal entry is 0 or missing; "" if there is none.
std::string zeroDiagonal(const SparseMatrix& a);

}  // namespace linear
