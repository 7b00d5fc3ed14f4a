// SPDX-License-Identifier: MIT
//
// How a stream's elements lie in its textures: as they are where they fit, else linearised. Plain
// arithmetic, no GL. Shapes are rows first on this side, x first on the assembler's.
#pragma once

#include <cstdint>
#include <vector>

#include "assemble/region_layout.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"
#include "sk/stream.hpp"

namespace sk {

struct Layout {
  assemble::RegionLayout whole;             ///< where the stream's elements are
  assemble::TextureShape texture;        ///< of each plane; of no size where the stream is empty
  std::vector<assemble::Rect> draws;     ///< what a pass over the whole stream draws
};

/// The layout of a stream of this shape. `packed`: four elements a texel; the rows are a multiple of that. Throws sk::Error
/// where no texture holds it, or it has no dimension.
Layout layoutOf(const Shape& shape, const assemble::TextureLimits& limits, bool packed = false);

/// Whether the rows of a stream of this shape are a multiple of four, and there are some.
bool mayPack(const Shape& shape);

/// That of a list of so many elements: linearised, whatever their number. Throws sk::Error where no texture
/// holds them.
Layout listLayout(std::int64_t length, const assemble::TextureLimits& limits);

/// Where the elements of a region lie, given the layout of its stream.
assemble::RegionLayout regionLayoutOf(const StreamRegion& region, const Layout& layout);

/// The shape reversed: x first, missing dimensions 1.
assemble::Index4 xFirst(const Shape& shape);

/// Whether each element of both regions, of equal shape, is at the same place in the same texel.
bool haveSameTexels(const assemble::RegionLayout& a, const assemble::RegionLayout& b);

}  // namespace sk
