// SPDX-License-Identifier: MIT
//
// Where the elements of a region of a stream lie in its textures: the numbers that the uniforms of
// an assembled program stand for, and which texels a pass over such a region has to draw. Plain
// arithmetic; it knows no texture.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "sk/limits.hpp"

namespace sk::assemble {

/// x fastest, that is, a C++ shape reversed.
using Index4 = std::array<std::int32_t, 4>;

/// A region of a stream. Plane: element (x, y) of the stream is texel (x, y). Linear: element number
/// n, row-major in the stream's whole shape, is texel (n & (1 << shift) - 1, n >> shift). Layered: linear in an
/// array texture whose layers are as high as they are wide and continue each other, so that texel (x, y) is texel
/// (x, y & (1 << shift) - 1) of layer y >> shift. Packed: a texel holds four elements that follow each other in x, of
/// which each row of the stream has a multiple. Element (x, y) is component x & 3 of texel (x >> 2, y), element number n
/// component n & 3 of the texel that number n >> 2 would have.
struct RegionLayout {
  bool linear = false;
  bool packed = false;
  bool layered = false;  ///< only where linear
  bool view = false;  ///< less than the whole stream
  Index4 origin = {0, 0, 0, 0};  ///< first index of the region in its stream
  Index4 extent = {1, 1, 1, 1};  ///< shape of the region; missing dimensions 1
  Index4 stride = {1, 1, 1, 1};  ///< linear: stridesOf() the whole stream
  std::int32_t shift = 0;  ///< linear: log2 of the texture's width

  bool operator==(const RegionLayout&) const = default;
};

/// Number of elements of the region.
std::int64_t elements(const Index4& extent);

/// Elements to step in each dimension of a whole stream of this shape {X, Y, Z, W}: {1, X, XY, XYZ}.
Index4 stridesOf(const Index4& extent);

/// Elements in a texel of a packed stream.
inline constexpr std::int32_t lanes = 4;

/// Whether a region of a packed stream is made of whole texels.
bool isWholeTexels(const RegionLayout& region);

/// Such a region with its texels for elements, which lie as those of a stream that is not packed.
RegionLayout texelsOf(const RegionLayout& region);

/// How many dimensions of an index in the region can be other than 0: Variant::domainRank for it.
std::uint8_t decodedRank(const RegionLayout& region);

/// How large a texture may be.
struct TextureLimits {
  std::int32_t size;  ///< width and height
  std::int32_t layers;  ///< of an array texture
};

/// How large a texture is.
struct TextureShape {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::int32_t layers = 0;  ///< 0: it is no array texture
  bool operator==(const TextureShape&) const = default;
};

/// The texture of `count` linearised elements, 1 or more (at most sk::mostElements). Its width is the smallest power of two that is not below
/// sqrt(count) but fits; where such a texture does not hold them, it has layers, of the largest size that leaves
/// at most an eighth of the texels unused. None where those are too many.
std::optional<TextureShape> linearTexture(std::int64_t count, const TextureLimits& limits);

/// Where `count` elements lie in it by their numbers alone.
RegionLayout linearLayout(std::int64_t count, const TextureShape& texture);

/// A rectangle of texels. In a layered texture, rows count on from layer to layer.
struct Rect {
  std::int32_t x, y, width, height;
  bool operator==(const Rect&) const = default;
};

/// The rectangles that a pass over the region, which is of whole texels, draws, one draw each, to write every element of it. They
/// hold no texel that is not an element of the stream, so that no kernel ever runs on what lies in
/// the unused end of a linearised texture. Empty where the region is; at most three.
std::vector<Rect> drawnTexels(const RegionLayout& region);

/// Whether these rectangles have even edges all around, so that the quads of 2 x 2 fragments that GPUs shade lie inside.
bool drawsWholeQuads(const RegionLayout& region);

}  // namespace sk::assemble
