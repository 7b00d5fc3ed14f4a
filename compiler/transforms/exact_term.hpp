// SPDX-License-Identifier: MIT
//
// What an element adds to an exact sum, for native code, where the runtime adds terms without rounding: the inputs that the
// term is made of, or a kernel that computes it.
//
//   before   reduce void r(float x<>, float y<>, reduce float total<>) { if (y > 0) total += x * (y - 1); }
//   after    the same, whose term is computed by
//            kernel void r_terms(float x<>, float y<>, out float term_0<>, out float factor_0<>) {
//              term_0 = -0; factor_0 = 1;
//              if (y > 0) { term_0 = x; factor_0 = y - 1; }
//            }
#pragma once

#include "ir/ir.hpp"
#include "transforms/scalar_sum.hpp"

namespace skc {

/// The term of a sum of reduce `id`; empty where an element adds terms in a loop, or more than a kernel has outputs for.
/// May add a kernel to the module. `areProducts`: the sum is one of products, where other terms have the factor 1.
ir::ExactTerm exactTerm(ir::Module& module, ir::KernelId id, const ScalarSum& sum, bool areProducts);

}  // namespace skc
