// SPDX-License-Identifier: MIT
//
// Gathers that a loop walks along: each iteration reads the next element of a row, and lanes read different rows, as in a
// product of a matrix and a vector. Code for a block of iterations reads the elements of each lane with vector loads and
// transposes them, which takes far less time than gather instructions:
//
//   for (int k = 0; k < n; ++k) dot += a[row][k] * x[k];
//
//   for (int k = 0; k < n;) {
//     if (a[row][k] to a[row][k + 15] are inside, for all lanes) {
//       load and transpose them to block[0] ... block[15];
//       for (int j = 0; j < 16 && k < n; ++j, ++k) dot += block[j] * x[k];
//     } else {
//       dot += a[row][k] * x[k];
//       ++k;
//     }
//   }
//
// The loop keeps its condition before each iteration and the order of all operations. This file only finds such gathers.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"

namespace skc::native {

/// A gather of a loop whose index grows by one along x in each iteration.
struct BlockGather {
  const ir::Expr* read;
  /// Its index as the loop's body has it, but free of the body's own variables: it can be computed before the body runs.
  ir::ExprPtr index;

  std::uint32_t stream() const { return std::get<ir::GatherRead>(read->node).stream.id; }
};

/// The gathers of a loop of this function that are worth reading in blocks. Empty where the body is too large to be repeated.
std::vector<BlockGather> blockGathers(const ir::Module& module, const ir::Kernel& kernel,
                                      const analysis::Uniformity& uniformity, ir::FunctionId function,
                                      const ir::Loop& loop);

}  // namespace skc::native
