// SPDX-License-Identifier: MIT
//
// Runs a function on a thread with a large stack, so that recursion over a deeply nested program ends in an
// error message and not in a crash.
#pragma once

#include <functional>

namespace skc::driver {

/// Returns what `work` returns.
int withBigStack(const std::function<int()>& work);

}  // namespace skc::driver
