// SPDX-License-Identifier: MIT
//
// Where the elements of a region are in their stream, as row-major numbers. Must not depend on how a device stores
// them.
#pragma once

#include <array>
#include <cstdint>

#include "sk/stream.hpp"

namespace sk {

/// A region as an affine map: the element at index i is number first + sum(i[d] * stride[d]) of its stream. The fastest
/// dimension comes first; missing dimensions have extent 1.
struct AffineRegion {
  std::int64_t first = 0;
  std::array<std::int64_t, 4> stride{};
  std::array<std::int64_t, 4> extent{1, 1, 1, 1};

  /// The number of the last element. The region is not empty.
  std::int64_t last() const;
  bool operator==(const AffineRegion&) const = default;
};

/// The region's stream must be settled.
AffineRegion affine(const StreamRegion& region);

/// Whether the region is a box of its stream, with the stream's own rank.
inline bool isBox(const StreamRegion& region) { return region.stride.rank() == 0; }

/// Whether kernels see a whole of which the region is a part.
inline bool isPlaced(const StreamRegion& region) { return region.placement.whole.rank() != 0; }

/// The shape that kernels see.
inline const Shape& seenShape(const StreamRegion& region) {
  return isPlaced(region) ? region.placement.whole : region.shape;
}

/// The index that kernels see in dimension `d` of the region's first element.
inline std::int64_t originOf(const StreamRegion& region, int d) {
  return isPlaced(region) ? region.placement.origin[d] : 0;
}

/// Whether the region has all elements of its stream, which must be settled.
bool isWhole(const StreamRegion& region);

/// Whether both have the same elements at the indices that kernels see. They are regions of one stream.
bool isSameRegion(const StreamRegion& a, const StreamRegion& b);

/// Whether two regions have an element in common. May be true for regions that interleave in different shapes.
bool overlap(const StreamRegion& a, const StreamRegion& b);

}  // namespace sk
