// SPDX-License-Identifier: MIT
//
// Finds gathers with which each lane walks along a row of its own in a loop, as in a matrix-vector product.
// Code for a block of iterations reads the elements of each lane with vector loads and transposes them, which
// is much faster than gather instructions:
//
//   for (int k = 0; k < n; ++k) dot += a[row][k] * x[k];
//
//   for (int k = 0; k < n;) {
//     if (a[row][k] to a[row][k + 15] are in bounds in all lanes) {
//       load and transpose them to block[0] ... block[15];
//       for (int j = 0; j < 16 && k < n; ++j, ++k) dot += block[j] * x[k];
//     } else {
//       dot += a[row][k] * x[k];
//       ++k;
//     }
//   }
//
// The loop still tests its condition before each iteration, and the order of operations does not change.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"

namespace skc::native {

/// A gather in a loop whose index grows by one along x in each iteration.
struct BlockGather {
  const ir::Expr* read;
  /// Its index, without variables that the loop's body declares: it can be computed before the body runs.
  ir::ExprPtr index;

  std::uint32_t stream() const { return std::get<ir::GatherRead>(read->node).stream.id; }
};

/// The gathers in a loop of this function that are worth reading in blocks; empty if the body is too large to
/// be emitted twice.
std::vector<BlockGather> blockGathers(const ir::Module& module, const ir::Kernel& kernel,
                                      const analysis::Uniformity& uniformity, ir::FunctionId function,
                                      const ir::Loop& loop);

}  // namespace skc::native
