// SPDX-License-Identifier: MIT
//
// Orders of a matrix's rows in which groups of rows do not depend on each other, so that a device computes a group at once; and incomplete
// factors in such an order. All of it runs on the host, once for a matrix.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "sparse.hpp"

namespace sk::linear {

/// Row i of the new order is row order[i] of the matrix. Group g has the rows starts[g] to starts[g + 1] - 1; no two rows of a group have an entry
/// in each other's column.
struct Ordering {
  std::vector<std::int32_t> order;
  std::vector<std::int64_t> starts{0};
  std::int64_t groups() const { return static_cast<std::int64_t>(starts.size()) - 1; }
};

/// Few groups: greedy colouring, each row in the first colour that none of its neighbours has. Red and black on the grids of a stencil.
Ordering colours(const SparseMatrix& a);
/// The natural order, so that factors are those of the matrix as it is: a row's level is one more than the highest of those before it that it depends on
/// (E. Anderson and Y. Saad, "Solving sparse triangular linear systems on parallel computers", 1989).
Ordering levels(const SparseMatrix& a);
/// "colours" or "levels". Throws sk::Error for another name.
Ordering orderingNamed(std::string_view name, const SparseMatrix& a);

/// The matrix with rows and columns in another order.
SparseMatrix permuted(const SparseMatrix& a, std::span<const std::int32_t> order);

/// The incomplete factors of a matrix on its own pattern (J. Meijerink and H. van der Vorst, 1977): L below the diagonal, whose own is 1, and U. Returns the
/// row whose pivot is 0, or, if `needsPositive`, not above 0; -1 if there is none.
std::int64_t factorise(SparseMatrix& a, bool needsPositive);

/// What incomplete factors with a dual threshold keep.
struct Threshold {
  double drop = 1e-3;  ///< of L, factors of this magnitude; of U, this part of the 2-norm of the matrix's row
  std::int64_t fill = 20;  ///< the largest entries of a row of L, and of a row of U beside the diagonal
};

/// ILUT (Y. Saad, "ILUT: a dual threshold incomplete LU factorization", 1994), in the order of the rows. `factors` becomes L below the diagonal, whose own is 1, and U. Returns the row whose pivot
/// is 0 or not finite; -1 if there is none.
std::int64_t factoriseByThreshold(const SparseMatrix& a, const Threshold& threshold, SparseMatrix& factors);

}  // namespace sk::linear
