// SPDX-License-Identifier: MIT
//
// SK_CHECK=written: finds reads of streams that the application has created and nothing has written. A stream counts as
// written once an operation has written any element of it. Must not depend on the kind of device.
//
// Reads the environment variable SK_CHECK, which enables slow checks for finding mistakes.
#pragma once

#include <span>
#include <string_view>

#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

// All throw sk::Error for a value that names no check. The first device or domain that is opened asks for the value, so that a check
// that does not exist is not taken for one that finds nothing.

/// Throws sk::Error if SK_CHECK names no check.
void requireKnownCheck();

/// Whether SK_CHECK is `folds`: reductions are tested on elements of each call (native/check_fold.hpp).
bool checksFolds();
/// Whether SK_CHECK is `halos`: the reach of gathers is tested on elements of each call (call/check_halos.hpp).
bool checksHalos();
/// Whether SK_CHECK is `written`: reads of streams that nothing has written are refused (call/check_written.hpp).
bool checksWritten();
/// Whether SK_CHECK is `collectives`: the ranks of a domain compare every call (mpi/agreement.hpp).
bool checksCollectives();

class StreamState;

/// Throws sk::Error if a kernel or fold would read elements of `parameter` that nothing has written.
void checkWritten(const program::Kernel& kernel, const program::Parameter& parameter,
                  const StreamState& stream);

/// Likewise for an operation that is no kernel; `context` names it.
void checkWritten(const StreamState& stream, std::string_view context);

/// Notes that a call writes its outputs. All of its arguments must have been checked before, because a stream may be both.
void noteWritten(const program::Kernel& kernel, std::span<const Argument> arguments);

}  // namespace sk
