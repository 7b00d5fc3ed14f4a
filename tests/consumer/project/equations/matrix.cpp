// SPDX-License-Identifier: MIT
//
// A matrix by sk/sparse_matrix.hpp alone, which includes no other header of the library.
#include <sk/sparse_matrix.hpp>

sk::linear::SparseMatrix chain(std::int64_t n) {
  std::vector<sk::linear::Entry> entries;
  for (std::int64_t i = 0; i < n; ++i) {
    entries.push_back({i, i, 2.0});
    if (i > 0) entries.push_back({i, i - 1, -1.0});
    if (i + 1 < n) entries.push_back({i, i + 1, -1.0});
  }
  return sk::linear::assemble(n, n, entries);
}
