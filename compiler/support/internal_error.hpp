// SPDX-License-Identifier: MIT
//
// Ends skc after a bug of its own, and remembers what skc was doing, for the report of a crash (driver/crash_report.hpp).
#pragma once

#include <string_view>

namespace skc {

/// Prints `skc: internal error: WHAT` and raises SIGABRT. The text names the bug in one line; it never holds a whole module.
[[noreturn]] void internalError(std::string_view what);

/// True after a call of internalError.
bool isInternalErrorPrinted();

/// Remembers what skc does from now on: a transform or another phase, and the kernel that it works on, if it works on one.
void noteActivity(std::string_view phase, std::string_view kernel = {});

/// The last activity, such as "native code, kernel 'f'"; "" if there is none. Safe in a signal handler.
const char* currentActivity();

}  // namespace skc
