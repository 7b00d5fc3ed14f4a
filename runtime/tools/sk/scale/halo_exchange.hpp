// SPDX-License-Identifier: MIT
//
// Counts what a rank sends when a grid is split into blocks and halos are exchanged, as sk::Domain does it: one message to
// each neighbour, also to those at edges and corners, with the elements of all streams that the call reads. Only integers;
// network.hpp has times.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sk_tool {

/// One number for each dimension, rows first, as in sk::Shape.
using Extents = std::vector<std::int64_t>;

/// How far elements are read before and after the own one, in one dimension.
struct Halo {
  std::int64_t below = 0, above = 0;

  std::int64_t both() const { return below + above; }
  bool operator==(const Halo&) const = default;
};

/// All ways to write `count` as a product of numbers, one for each dimension, in lexicographic order.
std::vector<Extents> processGrids(std::int64_t count, std::size_t rank);

/// How many dimensions have more than one part.
int splitDimensions(const Extents& parts);

/// Elements of part `index` of `parts` of an extent: the first parts have one more where they cannot be equal.
std::int64_t partExtent(std::int64_t extent, std::int64_t parts, std::int64_t index);

/// The elements of a block.
std::int64_t volumeOf(const Extents& block);

/// The split of a grid.
struct Split {
  Extents parts;  ///< of each dimension
  std::vector<bool> periodic;  ///< for each dimension

  /// The halo of a dimension that is exchanged: none if it is not split. If each of two parts is both before and after the
  /// other, both sides are as deep as the deeper one.
  Halo halo(std::size_t dimension, const Halo& read) const;
};

/// A stream whose halo is exchanged.
struct ExchangedStream {
  std::int64_t bytes = 0;  ///< of an element
  std::vector<Halo> halo;  ///< for each dimension
};

struct Sent {
  std::int64_t messages = 0;
  double bytes = 0;
};

/// What the rank at `place` in the grid of processes, with this block, sends for an exchange of all these streams.
Sent sentBy(const Split& split, const Extents& block, const Extents& place,
            std::span<const ExchangedStream> streams);

}  // namespace sk_tool
