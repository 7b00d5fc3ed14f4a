// SPDX-License-Identifier: MIT
//
// A GLSL function that sums unsigned numbers over a work group, for compute programs.
#pragma once

#include <string_view>

namespace sk::assemble {

/// Defines `uint sk_sums_before(uint value, out uint sum)`: the sum over the invocations before this one, and over all.
/// All invocations of the group, 256 in x, must call it.
std::string_view groupSums();

}  // namespace sk::assemble
