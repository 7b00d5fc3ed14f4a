// SPDX-License-Identifier: MIT
//
// The same hierarchy with nodes of eight children, whose boxes are bytes (H. Ylitie, T. Karras, S. Laine, "Efficient incoherent ray traversal on
// GPUs through compressed wide BVHs", 2017). It knows no device.
#pragma once

#include <cstdint>
#include <vector>

#include <sk/types.hpp>

#include "bvh.hpp"

namespace rays {

/// Children of a wide node. Bit k of a child's slot says on which side of axis k it lies, so that a ray whose direction has the signs `octant`
/// meets slots in the order of slot ^ octant.
inline constexpr int wideChildren = 8;

/// How many wide nodes there may be: kernels keep a node's number and a bit for each child in an int.
inline constexpr std::size_t mostWideNodes = std::size_t{1} << 23;

struct WideBvh {
  /// Four elements a node. The first has the bits of the origin's coordinates, and a byte for each axis: the biased exponent of what a step
  /// is long. The others have a byte for each child, in steps from the origin: (low x, low y), (low z, high x), (high y, high z), each of
  /// them in two ints, slots 0 to 3 and 4 to 7.
  std::vector<sk::int4> nodes;
  /// Eight a node: the child's number; or -(8 first + count), the shapes of a leaf in Bvh::order; -8 for none.
  std::vector<std::int32_t> children;

  std::size_t size() const { return nodes.size() / 4; }
};

/// Opens the child with the largest surface until a node has eight. Boxes hold those of `bvh`, with so much room that kernels
/// may compute distances from bytes (docs/rays.md). Throws std::runtime_error beyond mostWideNodes.
WideBvh widen(const Bvh& bvh);

}  // namespace rays
