// SPDX-License-Identifier: MIT
//
// unroll-loops: writes the rounds of short counted loops one after the other, where that makes offsets of neighbours and
// indices of arrays constants, or where a loop is hardly longer so. Outputs are packed, and neighbours are fetched once for
// all of them, only where every offset is known.
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
// Elements of constant arrays take the place of `weight[0]`, and integers are computed; arithmetic on floats stays as it is,
// in its order, so that no result changes. A loop that values of elements may leave stays a loop. What became of a kernel's
// loops, and why, is written to Kernel::loops.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

/// The most rounds of a loop, with those of the loops in it, and the most expressions that a kernel's loops become.
constexpr std::int64_t mostUnrolledRounds = 64;
constexpr std::int64_t mostUnrolledExpressions = 1000;

void unrollLoops(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
