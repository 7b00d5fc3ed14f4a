// SPDX-License-Identifier: MIT
//
// Determines what an element adds to an exact sum, for native code, whose runtime adds terms without
// rounding: the inputs that form the term, or a kernel that computes it.
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

/// The term of a sum of reduce `id`; empty if an element adds terms in a loop, or more terms than a kernel
/// can output. May add a kernel to the module. `areProducts`: other terms get the factor 1.
ir::ExactTerm exactTerm(ir::Module& module, ir::KernelId id, const ScalarSum& sum, bool areProducts);

}  // namespace skc
