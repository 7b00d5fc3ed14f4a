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
/// The counts of a work group of RadixStep::Sum, and the words of one of Store and StorePairs.
inline constexpr std::int32_t radixSumTile = 4096;

/// The keys of a work group of the other steps. With subgroups, a group needs 42 KiB of shared memory, which leaves room for four
/// groups on a multiprocessor of an H200; without, it needs no more than the 32 KiB that every device has.
std::int32_t radixTile(const Profile& profile);

enum class RadixStep : std::uint8_t {
  Count,  ///< keys to counts: digit d of tile t has number d * tiles + t
  CountPairs,  ///< Count of the keys of pairs
  Sum,  ///< counts to the sums before them in their tile, and the tile's totals
  Move,  ///< keys, sums and totals to keys
  MoveFirst,  ///< the same to pairs of keys and their numbers: the places where they came from
  MovePairs,  ///< pairs, sums and totals to pairs
  Store,  ///< keys from the buffer to a texture
  StorePairs,  ///< pairs likewise
};
inline constexpr std::size_t radixSteps = 8;

/// Where a step has its keys or pairs: in the buffer at binding 0, from number sk_from and sk_to on, or in textures.
struct RadixStorage {
  bool reads = false, writes = false;  ///< it reads them from the buffer, writes them to it
};

/// What keys are to a sort.
enum class RadixKeys : std::uint8_t {
  Words,  ///< unsigned numbers, after an exclusive or with sk_flip
  Floats,  ///< bits of floats. Those of both zeros are equal, all NaNs come last; sk_flip inverts the order of all others
};
inline constexpr std::size_t radixKeyTypes = 2;

/// The program of a step. It is dispatched in rows of 2^15 groups (tileGroup's), one for each tile, and has the uniforms
/// sk_rect, sk_length, sk_tiles, sk_keys_shift, sk_counts_shift, sk_totals_shift, sk_digit, sk_flip, sk_from and sk_to; its
/// samplers are sk_keys, of keys or pairs, sk_counts, sk_sums and sk_totals. All textures are linearised.
std::string radixProgram(const Profile& profile, RadixStep step, RadixKeys keys = RadixKeys::Words,
                         RadixStorage storage = {});

/// Defines `uint sk_sums_before(uint value, out uint sum)`: the sum over the invocations before this one, and over all.
/// All invocations of the group, 256 in x, must call it.
std::string_view groupSums();

}  // namespace sk::assemble
