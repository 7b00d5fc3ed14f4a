// SPDX-License-Identifier: MIT
//
// A GLSL function that sums unsigned numbers over a work group, for compute programs.
#pragma once

#include <cstdint>
#include <string_view>

namespace sk::assemble {

/// The invocations of the work groups, in x.
inline constexpr std::int32_t summingGroup = 256;

/// Defines `uint sk_sums_before(uint value, out uint sum)`: the sum over the invocations before this one, and over all.
/// All invocations of the group must call it.
std::string_view groupSums();

}  // namespace sk::assemble
