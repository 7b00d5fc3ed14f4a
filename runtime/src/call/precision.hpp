// SPDX-License-Identifier: MIT
//
// Chooses the variant of a kernel or a reduction for the precision of a call, and rounds the results of a
// reduction in doubles to floats. Only devices with GLSL programs use variants; native code computes in any
// real type.
#pragma once

#include <span>

#include "call/resolved_call.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether floats are computed as doubles or as pairs of floats.
constexpr bool isWide(const CallOptions& options) {
  return options.precision == Precision::Extended || options.precision == Precision::Double ||
         (options.precision != Precision::Half && options.accumulate == Accumulate::Extended);
}

/// Whether they are computed as pairs of floats even if the device has doubles.
constexpr bool isExtended(const CallOptions& options) {
  return isWide(options) && options.precision != Precision::Double;
}

/// Whether the call needs another variant than the one that computes in floats.
constexpr bool needsPrecisionVariant(const CallOptions& options) {
  return isWide(options) || options.precision == Precision::Half;
}

/// The kernel's variant for a call; the kernel itself for floats, or if it has no floats. Throws sk::Error if
/// there is none.
const program::Kernel& precisionVariant(const program::Kernel& kernel, const CallOptions& options);

/// The reduction's variant in half; the reduction itself if it has no floats. Throws sk::Error if there is
/// none.
const program::Reduction& halfVariant(const program::Reduction& reduction);

/// Throws sk::Error if a call requests tables in a precision other than float.
void checkTables(const program::Kernel& kernel, const CallOptions& options);

/// Throws sk::Error if a call of a kernel or a reduce requests what only a scan can do.
void refuseScanOptions(const program::Kernel& kernel, const CallOptions& options);

/// Reduces with the variant that the options select. Throws sk::Error if there is none.
void reduceInPrecision(const ResolvedReduction& call);

/// Reduces with a variant that has the same parameters, but for the accumulators, which are converted in the end.
void reduceWide(const ResolvedReduction& call, const program::WideReduction& wide);

}  // namespace sk
