// SPDX-License-Identifier: MIT
//
// The compute programs that sort words by a digit of 8 bits, stably (D. Merrill and A. Grimshaw, "High performance and
// scalable radix sorting", 2011). Sorting by each digit in turn, lowest first, sorts by all of them.
//
// A GLSL function that sums unsigned numbers over a work group, for compute programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "assemble/assemble.hpp"

namespace sk::assemble {

inline constexpr std::int32_t radixDigits = 256;
/// The keys, or counts, of a work group.
inline constexpr std::int32_t radixTile = 4096;

enum class RadixStep : std::uint8_t {
  Count,  ///< keys to counts: digit d of tile t has number d * tiles + t
  Sum,  ///< counts to the sums before them in their tile, and the tile's totals
  Move,  ///< keys, sums and totals to keys
  MoveFirst,  ///< the same to pairs of keys and their numbers: the places where they came from
  MovePairs,  ///< pairs, sums and totals to pairs
  CountPairs,  ///< Count of the keys of pairs in the buffer
  StorePairs,  ///< pairs from the buffer to a texture
};
inline constexpr std::size_t radixSteps = 7;

/// Where a step has its pairs: in the buffer at binding 0, from number sk_from and sk_to on, or in textures.
struct RadixStorage {
  bool reads = false, writes = false;  ///< it reads them from the buffer, writes them to it
};

/// The program of a step. It is dispatched in rows of 2^15 groups (tileGroup's), one for each tile, and has the uniforms
/// sk_rect, sk_length, sk_tiles, sk_keys_shift, sk_counts_shift, sk_totals_shift, sk_digit, sk_from and sk_to; its samplers
/// are sk_keys, of keys or pairs, sk_counts, sk_sums and sk_totals. All textures are linearised.
std::string radixProgram(const Profile& profile, RadixStep step, RadixStorage storage = {});

/// Defines `uint sk_sums_before(uint value, out uint sum)`: the sum over the invocations before this one, and over all.
/// All invocations of the group, 256 in x, must call it.
std::string_view groupSums();

}  // namespace sk::assemble
