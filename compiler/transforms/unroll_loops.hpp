// SPDX-License-Identifier: MIT
//
// unroll-loops: unrolls short counted loops if that makes offsets of neighbours and indices of arrays
// constant, or if the code hardly grows. Only if every offset is known can outputs be packed, and neighbours
// be fetched once for all of them.
//
//   before   for (int dy = -1; dy <= 1; ++dy)
//              for (int dx = -1; dx <= 1; ++dx) {
//                if (dx == 0 && dy == 0) continue;
//                float w = weight[dx + 1];
//                sum += w * neighbor(a, dx, dy);
//              }
//   after    { float w = weight[0];  sum += w * neighbor(a, -1, -1); }
//            { float w = weight[1];  sum += w * neighbor(a, 0, -1); }  ...
//
// `weight[0]` is replaced by the element of the constant array, and integers are computed; float arithmetic
// keeps its order, so that no result changes. A loop that elements may leave early stays a loop.
// Kernel::loops records what became of each loop, and why.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

/// Limits: iterations of a loop including the loops in it, and expressions in all unrolled loops of a kernel.
constexpr std::int64_t mostUnrolledIterations = 64;
constexpr std::int64_t mostUnrolledExpressions = 1000;

void unrollLoops(ir::Module& module, Diagnostics& diagnostics);
/// Likewise, for one kernel, which may not be in the module yet.
void unrollLoops(ir::Module& module, ir::Kernel& kernel);

}  // namespace skc
