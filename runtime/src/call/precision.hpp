// SPDX-License-Identifier: MIT
//
// Which form of a kernel or a reduction computes in the precision that a call asks for, and how a reduction in doubles
// gives floats. Forms are what devices with GLSL programs take; native code computes in any real type.
#pragma once

#include <span>

#include "call/resolved_reduction.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether floats are computed as doubles, or as pairs of floats.
constexpr bool isWide(const CallOptions& options) {
  return options.precision == Precision::Extended || options.precision == Precision::Double ||
         (options.precision != Precision::Half && options.accumulate == Accumulate::Extended);
}

/// Whether they are pairs of floats then, even where the device has doubles.
constexpr bool isExtended(const CallOptions& options) {
  return isWide(options) && options.precision != Precision::Double;
}

/// Whether it takes another form than the one that computes in floats.
constexpr bool takesForm(const CallOptions& options) {
  return isWide(options) || options.precision == Precision::Half;
}

/// The kernel's form for a call; itself for floats, and where it computes none. Throws sk::Error where it has none.
const program::Kernel& formOf(const program::Kernel& kernel, const CallOptions& options);

/// The reduction's form in half precision; itself where it computes no floats. Throws sk::Error where it has none.
const program::Reduction& halfForm(const program::Reduction& reduction);

/// Throws sk::Error where a call asks for tables in another precision than theirs, which is float's.
void checkTables(const program::Kernel& kernel, const CallOptions& options);

/// Reduces in the form that the options take. Throws sk::Error where there is none.
void reduceInForm(const ResolvedReduction& call);

}  // namespace sk
