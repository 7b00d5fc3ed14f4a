// SPDX-License-Identifier: MIT
//
// The layout of a region of a stream in its textures: the values of an assembled program's uniforms, and the
// texels that a pass over the region draws. Pure arithmetic; must not depend on textures.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "sk/limits.hpp"

namespace sk::assemble {

/// Fastest dimension first: a C++ shape reversed.
using Index4 = std::array<std::int32_t, 4>;

/// The whole of which a region is a part (sk/placed.hpp).
struct Place {
  /// The index in the whole of the region's first element. Of a local gather: the index in the region of the domain's first
  /// element.
  Index4 low = {0, 0, 0, 0};
  Index4 high = {1, 1, 1, 1};  ///< gathers: indices from `low` to `high` (exclusive) are held
  Index4 whole = {1, 1, 1, 1};  ///< the whole's extents

  bool operator==(const Place&) const = default;
};

/// A region of a stream. Plane: element (x, y) of the stream is texel (x, y). Linear: row-major element
/// number n of the whole stream is texel (n & (1 << shift) - 1, n >> shift). Layered: linear in an array
/// texture with consecutive square layers, so that texel (x, y) is texel (x, y & (1 << shift) - 1) of layer y
/// >> shift. Packed: a texel holds four elements that are consecutive in x, and each row of the stream has a
/// multiple of four. Element (x, y) is component x & 3 of texel (x >> 2, y); element number n is component n
/// & 3 of the texel that number n >> 2 would have. Strided: the element at index i of a plane is that at origin + i *
/// stride of the stream; by number, it has the number origin[0] + sum(i * stride).
struct RegionLayout {
  bool linear = false;
  bool packed = false;
  bool layered = false;  ///< only if linear
  bool view = false;  ///< less than the whole stream, or in another shape
  bool strided = false;
  bool numbered = false;  ///< a strided region of a plane, by number: the stream's rows follow each other
  Index4 origin = {0, 0, 0, 0};  ///< first index of the region in its stream
  Index4 extent = {1, 1, 1, 1};  ///< shape of the region; missing dimensions 1
  Index4 stride = {1, 1, 1, 1};  ///< linear: stridesOf() of the whole stream; or as strided regions say
  std::int32_t shift = 0;  ///< linear: log2 of the texture's width; numbered: the elements of a row
  /// Programs speak of the whole. In a gather that is not local, `extent` is the whole's, and `origin` belongs to the whole's
  /// index 0.
  bool placed = false;
  bool local =
      false;  ///< placed gathers: indices and boundary modes are those of the region, as if it were not placed
  Place place = {};

  bool operator==(const RegionLayout&) const = default;
};

/// The number of elements in the region.
std::int64_t elements(const Index4& extent);

/// The element strides of a whole stream of this shape {X, Y, Z, W}: {1, X, XY, XYZ}.
Index4 stridesOf(const Index4& extent);

/// Elements per texel of a packed stream.
inline constexpr std::int32_t lanes = 4;

/// The stride of a missing dimension of a strided region by number, which no element number exceeds.
inline constexpr std::int32_t noStride = std::numeric_limits<std::int32_t>::max();

/// Whether a region of a packed stream consists of whole texels.
bool isWholeTexels(const RegionLayout& region);

/// Such a region with texels as its elements, in the layout of a stream that is not packed.
RegionLayout texelsOf(const RegionLayout& region);

/// The number of dimensions in which an index in the region may be nonzero: Variant::domainRank for it.
std::uint8_t decodedRank(const RegionLayout& region);

/// The largest texture of a device.
struct TextureLimits {
  std::int32_t size;  ///< width and height
  std::int32_t layers;  ///< of an array texture
  /// Whether linearised textures are narrow. GPUs keep neighbouring texels of two rows in one sector of memory, and work groups that write whole
  /// rows fill sectors (Function::Paired).
  bool isNarrow = false;
};

/// The size of a texture.
struct TextureShape {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::int32_t layers = 0;  ///< 0: it is not an array texture
  bool operator==(const TextureShape&) const = default;
};

/// The texture of `count` linearised elements, from 1 to sk::mostElements. Its width is a power of two: the smallest not
/// below sqrt(count), or, if that is more than 128 and textures are narrow, the smallest from 128 on whose rows fit. If the largest texture is too small, it has layers, of the largest size that leaves at
/// most an eighth of the texels unused. Nullopt if that takes too many layers.
std::optional<TextureShape> linearTexture(std::int64_t count, const TextureLimits& limits);

/// The layout of `count` elements in it, by number.
RegionLayout linearLayout(std::int64_t count, const TextureShape& texture);

/// A rectangle of texels. In a layered texture, rows are numbered across layers.
struct Rect {
  std::int32_t x, y, width, height;
  bool operator==(const Rect&) const = default;
};

/// The rectangles to draw, one per draw, in a pass that writes every element of the region, which consists of
/// whole texels. They contain only elements of the stream, so that no kernel ever runs on the unused end of a
/// linearised texture; those of a strided region also contain elements between. At most three; empty if the region is.
std::vector<Rect> drawnTexels(const RegionLayout& region);

/// Whether all edges of these rectangles are even, so that the 2 x 2 quads that GPUs shade are inside.
bool drawsWholeQuads(const RegionLayout& region);

}  // namespace sk::assemble
