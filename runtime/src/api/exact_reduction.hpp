// SPDX-License-Identifier: MIT
//
// Reductions with Accumulate::Exact. A variant of the reduction folds each scalar that is a sum of floats
// without rounding; the plain reduction folds all others. Must not depend on the kind of device.
#pragma once

#include "call/resolved_call.hpp"

namespace sk {

/// Requires a nonempty domain and a reduction that sums floats.
void reduceExactly(const ResolvedReduction& call);

}  // namespace sk
