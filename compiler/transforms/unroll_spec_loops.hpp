// SPDX-License-Identifier: MIT
//
// unroll-spec-loops: gives each kernel whose loops are bounded by an integer spec parameter a variant for each small
// value of it, in which unroll-loops has unrolled them all.
//
//   before   kernel void blur(spec int n, float a[], out float r<>) {
//              for (int i = -n; i <= n; ++i) r += neighbor(a, i);
//            }
//   after    the same, with the variants
//            { r += neighbor(a, -1);  r += neighbor(a, 0);  r += neighbor(a, 1); }    for n = 1
//            ...                                                                       for n = 2
//
// Variants compute the same. Calls with another value run the kernel as it is.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

/// The values that have variants begin with 1 and end here, or earlier: all variants of a kernel together have at most
/// mostUnrolledExpressions.
constexpr std::uint32_t mostUnrolledValue = 8;

void unrollSpecLoops(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
