// SPDX-License-Identifier: MIT
//
// Reads the environment variable SK_CHECK, which enables slow checks for finding mistakes.
#pragma once

namespace sk {

// All throw sk::Error for a value that names no check.

/// Whether SK_CHECK is `folds`: reductions are tested on elements of each call (native/check_fold.hpp).
bool checksFolds();
/// Whether SK_CHECK is `halos`: the reach of gathers is tested on elements of each call (call/check_halos.hpp).
bool checksHalos();
/// Whether SK_CHECK is `written`: reads of streams that nothing has written are refused (call/check_written.hpp).
bool checksWritten();
/// Whether SK_CHECK is `collectives`: the ranks of a domain compare every call (mpi/agreement.hpp).
bool checksCollectives();

}  // namespace sk
