// SPDX-License-Identifier: MIT
//
// Reductions whose arguments have been checked, for calls that consist of more than one. Must not depend on the kind of
// device.
#pragma once

#include <functional>

#include "call/resolved_reduction.hpp"
#include "sk/options.hpp"

namespace sk {

/// Adds the choices of the configuration file and the declaration. A file's choice for all reductions applies
/// only to those that sum floats.
CallOptions resolvedOptions(const ResolvedReduction& checked, const CallOptions& call);

/// Reduces with the variant that the options, the device and the results require. There is at least one block.
void reduceResolved(const ResolvedReduction& call);

/// Reduces to temporary streams of floats, calls between(), and copies the results. The call has streams for results.
void reduceByTemporaries(const ResolvedReduction& call, const std::function<void()>& between);

}  // namespace sk
