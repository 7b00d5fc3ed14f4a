// SPDX-License-Identifier: MIT
//
// Private to predicate: gives a counter that is read after its loop a copy that the loop reads. Lanes leave the loop at
// different times, so that the counter varies afterwards. As long as a lane stays in the loop, its counter has the
// same value as that of any other lane there: the copy is uniform.
//
//   int n = 0;                            int n = 0;
//                                         int count = 0;
//   while (n < most && f(x)) {            while (count < most && f(x)) {
//     ++n;                                  ++count;
//                                           ++n;
//   }                                     }
#pragma once

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"

namespace skc {

/// Copies the varying counters of the function's divergent loops if they start from a literal. Returns true if it
/// changed the function: `uniformity` does not describe it any more.
bool splitCounters(ir::Function& function, ir::FunctionId id, const analysis::Uniformity& uniformity);

}  // namespace skc
