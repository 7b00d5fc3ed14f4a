// SPDX-License-Identifier: MIT
//
// Reductions whose arguments have been checked, for calls that consist of more than one, and reductions with
// Accumulate::Exact: a variant of the reduction folds each scalar that is a sum of floats without rounding; the plain
// reduction folds all others. Must not depend on the kind of device.
#pragma once

#include <functional>

#include "call/resolved_call.hpp"
#include "sk/options.hpp"

namespace sk {

/// Adds the choices of the configuration file and the declaration. A file's choice for all reductions applies
/// only to those that sum floats.
CallOptions resolvedOptions(const ResolvedReduction& checked, const CallOptions& call);

/// The compensated variant if the call uses it, else null. An empty domain gives the plain reduction's identity.
const program::CompensatedReduction* compensatedVariant(const ResolvedReduction& call);

/// Whether the plain variant in doubles can replace the compensated one: not if a stream has bits that floats drop.
bool isInDoubles(const ResolvedReduction& call, const program::CompensatedReduction& second);

/// Whether the call uses the exact variant. An empty domain gives the plain reduction's identity.
bool isExact(const ResolvedReduction& call);

/// Whether native code sums in doubles beside the outputs of a fold.
bool foldsInDoubles(const ResolvedReduction& call);

/// Adds the rounding errors of sums to the sums, both in host memory: one value for each accumulator of the reduction, and
/// for each sum.
void addErrors(const program::Reduction& reduction, const program::CompensatedReduction& second,
               std::span<void* const> values, std::span<void* const> errors);

/// Reduces with the variant that the options, the device and the results require. There is at least one block.
void reduceResolved(const ResolvedReduction& call);

/// Stores the outputs of a kernel with folded outputs, which must be dense and have elements, and folds nothing.
void storeOutputs(const ResolvedReduction& call);

/// Reduces to temporary streams of floats, calls between(), and copies the results. The call has streams for results.
void reduceByTemporaries(const ResolvedReduction& call, const std::function<void()>& between);

/// Requires a nonempty domain and a reduction that sums floats.
void reduceExactly(const ResolvedReduction& call);

}  // namespace sk
