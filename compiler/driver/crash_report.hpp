// SPDX-License-Identifier: MIT
//
// Turns a crash of skc into a short report and exit status 1, so that a build ends with words that help.
#pragma once

namespace skc::driver {

/// From now on, a crash of the calling thread prints what to report and ends the process with status 1. Where the environment
/// has SKC_CRASH=signal, the process dies by the signal instead, for debuggers. Where memory ends,
/// or more than 8 GiB are needed, the message says so. Builds with sanitizers keep their own reports.
void reportCrashes(int argc, const char* const* argv);

}  // namespace skc::driver
