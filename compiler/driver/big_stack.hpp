// SPDX-License-Identifier: MIT
//
// Runs a function on a thread with a large stack: recursion over the tree of a program that nests
// deeply then ends in a message rather than a crash.
#pragma once

#include <functional>

namespace skc::driver {

/// Returns what `work` returns.
int withBigStack(const std::function<int()>& work);

}  // namespace skc::driver
