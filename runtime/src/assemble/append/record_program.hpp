// SPDX-License-Identifier: MIT
//
// The compute program that combines the records of a scatter output in order, for what atomic operations cannot combine so:
// sums of floats, and vectors. Records are the targets and values that a kernel has pushed (append/append_groups.hpp). A stable
// sort by targets has brought those of each target together, in the order of the elements.
#pragma once

#include <cstdint>
#include <string>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// The records of a work group.
inline constexpr std::int32_t recordTile = 1024;

/// The program for a scatter output that isListed(). It is dispatched in rows of 2^15 groups, one for each tile, and has the
/// uniforms sk_rect, sk_length, sk_tiles, sk_keys_shift, sk_list_shift and sk_width. Its samplers are sk_keys, of sorted pairs;
/// sk_count, of the number of records, if it `isCounted` on the device; and sk_values, of the list, unless a pair holds the value.
/// Image 0 is the target.
std::string recordProgram(const Profile& profile, const program::Parameter& scatter, bool isCounted);

}  // namespace sk::assemble
