// SPDX-License-Identifier: MIT
//
// Reductions with Accumulate::Exact: each scalar that is a sum of floats is folded by a form of its own, which adds without
// rounding, and put in its place; whatever else there is, the plain form folds. It knows no device.
#pragma once

#include <span>

#include "call/check_reduction.hpp"
#include "sk/call.hpp"

namespace sk {

/// To streams; the domain has elements, and the reduction sums of floats.
void reduceExactly(const program::Reduction& reduction, std::span<const Argument> arguments,
                   const CheckedReduction& checked, const CallOptions& options);
/// To values.
void reduceExactly(const program::Reduction& reduction, std::span<const Argument> arguments,
                   const CheckedReduction& checked, std::span<void* const> results,
                   const CallOptions& options);

}  // namespace sk
