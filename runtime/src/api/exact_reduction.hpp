// SPDX-License-Identifier: MIT
//
// Reductions with Accumulate::Exact: each scalar that is a sum of floats is folded by a form of its own, which adds without
// rounding, and put in its place; whatever else there is, the plain form folds. It knows no device.
#pragma once

#include "call/resolved_reduction.hpp"

namespace sk {

/// The domain has elements, and the reduction sums of floats.
void reduceExactly(const ResolvedReduction& call);

}  // namespace sk
