// SPDX-License-Identifier: MIT
//
// Reads the environment variable SK_CHECK, which enables slow checks for finding mistakes.
#pragma once

namespace sk {

/// Whether SK_CHECK is `folds`: reductions are tested on elements of each call (native/check_fold.hpp).
/// Throws sk::Error for any other value.
bool checksFolds();

}  // namespace sk
