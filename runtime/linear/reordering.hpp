// SPDX-License-Identifier: MIT
//
// Orders of unknowns that keep the entries of a matrix near its diagonal: reads of x are then close to each other, offsets from the diagonal fit in 16 bits,
// and incomplete factors lose less.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "sparse.hpp"

namespace sk::linear {

/// Row i of the new order is row order[i] of the matrix: breadth first from a row far from the others, neighbours of few entries first, and all of it
/// reversed (E. Cuthill and J. McKee, "Reducing the bandwidth of sparse symmetric matrices", 1969; A. George 1971). The first row of each connected part is
/// pseudo-peripheral (A. George and J. Liu, "An implementation of a pseudoperipheral node finder", 1979). An entry connects its row and its column.
std::vector<std::int32_t> reverseCuthillMcKee(const SparseMatrix& a);

/// The largest |column - row| of an entry.
std::int64_t bandwidth(const SparseMatrix& a);

/// The order that is called so: "none", which is empty, or "rcm". Throws sk::Error for another name.
std::vector<std::int32_t> reorderingNamed(std::string_view name, const SparseMatrix& a);

/// Element i becomes element order[i] of the vector; the vector itself if the order is empty.
std::vector<double> inOrder(std::span<const double> v, std::span<const std::int32_t> order);
/// The inverse of inOrder().
std::vector<double> inFormerOrder(std::span<const double> v, std::span<const std::int32_t> order);

}  // namespace sk::linear
