// SPDX-License-Identifier: MIT
//
// Finds loops in which all indices of a gather can be tested before the first iteration, as in a product of
// matrices. Without tests, an iteration only loads and multiplies:
//
//   for (int k = 0; k < n; ++k) sum += a[y][k] * b[k][x];
//
//   if (a[y][0] to a[y][n - 1] and b[0][x] to b[n - 1][x] are in bounds) {
//     for (int k = 0; k < n; ++k) sum += a.first[k] * b.first[k * b.stride];
//   } else {
//     for (int k = 0; k < n; ++k) sum += a[y][k] * b[k][x];
//   }
//
// Both loops have the same values: an index in bounds is what every boundary mode leaves as it is.
#pragma once

#include <vector>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"

namespace skc::native {

/// A gather in a loop of which each index either stays as it is or grows by one in each iteration.
struct UncheckedGather {
  const ir::Expr* read;
  ir::ExprPtr index;  ///< can be computed before the body runs
  std::vector<bool> grows;  ///< for each dimension, x first

  std::uint32_t stream() const { return std::get<ir::GatherRead>(read->node).stream.id; }
};

/// A loop over a counter that grows by one and stays below `limit`, or equal to it if that is included.
struct UncheckedLoop {
  const ir::Expr* counter = nullptr;
  const ir::Expr* limit = nullptr;
  bool includesLimit = false;
  std::vector<UncheckedGather> gathers;  ///< empty for any other loop
};

/// The gathers of a loop of this function whose indices are uniform, or consecutive along x; none if the body is too large
/// to be emitted twice.
UncheckedLoop uncheckedGathers(const ir::Module& module, const analysis::Uniformity& uniformity,
                               ir::FunctionId function, const ir::Loop& loop);

}  // namespace skc::native
