// SPDX-License-Identifier: MIT
//
// What the library itself asks of sparse matrices, beside what sk/sparse_matrix.hpp offers to everybody. It knows no device.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sk/sparse_matrix.hpp>

namespace sk::linear {

/// A B, in double precision, with all entries that the structures of A and B give, also if they add up to 0; std::nullopt as soon as it has more than `most` of them.
std::optional<SparseMatrix> multiply(const SparseMatrix& a, const SparseMatrix& b, std::int64_t most);
/// The largest sum of magnitudes of a row.
double infinityNorm(const SparseMatrix& a);
/// The diagonal; 0 where there is no entry.
std::vector<double> diagonal(const SparseMatrix& a);

/// A place where a matrix differs from its transpose, counted from 1 as in files, for messages; "" if it is symmetric. Row i is called order[i], if there is an order.
std::string asymmetry(const SparseMatrix& a, std::span<const std::int32_t> order = {});
/// "row 17", counted from 0, of the first row whose diagonal entry is 0 or missing; "" if there is none.
std::string zeroDiagonal(const SparseMatrix& a);

}  // namespace sk::linear
