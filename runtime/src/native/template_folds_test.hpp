// SPDX-License-Identifier: MIT
//
// Reductions by the templates of sk/native/fold.hpp, whose bits object code must give, too.
#pragma once

#include "sk/native/call.hpp"

namespace sk::test {

/// `total += x`, of floats; and `total += x` and `total += x * y` in doubles, of streams of floats. The operands are the inputs, and
/// then the result.
void templateSum(const native::ReduceCall& call);
void templateSumInDoubles(const native::ReduceCall& call);
void templateDotInDoubles(const native::ReduceCall& call);
/// `last = last * 0.75 + x`, in order, and seeded.
void templateInOrder(const native::ReduceCall& call);
/// Two accumulators: `total += x`, and `last = x + 0.5 * last`.
void templatePair(const native::ReduceCall& call);

}  // namespace sk::test
