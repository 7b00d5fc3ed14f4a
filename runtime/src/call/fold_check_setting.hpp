// SPDX-License-Identifier: MIT
//
// What the environment variable SK_CHECK asks for, which costs time and is for finding mistakes.
#pragma once

namespace sk {

/// Whether SK_CHECK is `folds`: reduces are tried on elements of each call (native/check_fold.hpp). Throws sk::Error for any
/// other value.
bool checksFolds();

}  // namespace sk
