// SPDX-License-Identifier: MIT
//
// GLSL functions with which the work groups of append_groups.hpp find where their pushes go. They work on the shared variables
// sk_counts, sk_sums, sk_tile, sk_look_low, sk_look_high and sk_look_nearest, and the states of tiles, sk_state. All invocations of a group,
// appendGroup in x, must call them. `hasSubgroups`: the program may use subgroups (glsl/subgroups.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sk::assemble {

/// `void sk_meet()`: waits for the group.
std::string_view meetFunction();
/// `uint sk_sum(uint a, uint b)`, which is at most countLimit, and `uint sk_scan()`: replaces the counts of a tile's texels by the
/// numbers of pushes before each; returns the number of all.
std::string scanOfCounts(int rounds, bool hasSubgroups);
/// `uint sk_look(uint sk_k, uint sk_own)`: publishes a tile's number of pushes to the list sk_k of `lists`, and adds up those of the tiles
/// before. A state is 0, or a number with a flag: 2^30 if it is the tile's own, 2^31 if it includes all tiles before.
std::string lookBack(std::size_t lists, bool hasSubgroups);
/// `uint sk_take(uint sk_k, uint sk_own)`: takes places for a tile's pushes as groups come.
std::string_view takePlace();

}  // namespace sk::assemble
