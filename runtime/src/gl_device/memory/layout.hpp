// SPDX-License-Identifier: MIT
//
// The layout of a stream's elements in its textures: a plane for streams of rank 2 and short ones of rank 1
// if a texture is large enough, else linearised. Pure arithmetic, no GL. An sk::Shape begins with the slowest
// dimension, an assemble::Index4 with x.
#pragma once

#include <cstdint>
#include <vector>

#include "assemble/region_layout.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"
#include "sk/stream.hpp"

namespace sk {

struct Layout {
  assemble::RegionLayout whole;  ///< of all elements
  assemble::TextureShape texture;  ///< of each plane; all 0 if the stream is empty
  std::vector<assemble::Rect> draws;  ///< the rectangles of a pass over the whole stream
};

/// The layout of a stream of this shape. `packed`: four elements per texel, if the stream is not empty; its
/// rows must be a multiple of four. Throws sk::Error if no texture is large enough, or if the rank is 0.
Layout layoutOf(const Shape& shape, const assemble::TextureLimits& limits, bool packed = false);

/// Whether a stream of this shape is not empty, and its rows have a multiple of four elements.
bool mayPack(const Shape& shape);

/// The layout of a list of `length` elements, which is always linearised. Throws sk::Error if no texture is
/// large enough.
Layout listLayout(std::int64_t length, const assemble::TextureLimits& limits);

/// The layout of a region, given the layout of its stream. It is strided only if no other layout describes it.
assemble::RegionLayout regionLayoutOf(const StreamRegion& region, const Layout& layout);

/// A box of a region of this rank, whose layout is not strided; all of it if the box is the whole domain.
assemble::RegionLayout partOf(const assemble::RegionLayout& region, int rank, const Box& box);

/// A region that holds a part of a whole, as a program gathers from it.
assemble::RegionLayout gatherLayout(const assemble::RegionLayout& region, const Placement& placement,
                                    program::Boundary boundary);

/// The same region as a local gather of a domain whose first element has the index `domain` in the whole.
assemble::RegionLayout localLayout(const assemble::RegionLayout& region, const Placement& placement,
                                   const Index& domain);

/// The extents of a shape, x first; missing dimensions are 1.
assemble::Index4 xFirst(const Shape& shape);
/// An index, x first; missing dimensions are 0.
assemble::Index4 xFirst(const Index& index);

/// Whether the regions have the same shape, and equal indices are at the same position in the same texel.
bool haveSameTexels(const assemble::RegionLayout& a, const assemble::RegionLayout& b);

}  // namespace sk
