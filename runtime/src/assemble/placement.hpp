// SPDX-License-Identifier: MIT
//
// Where the elements of a region of a stream lie in its textures: the numbers that the uniforms of
// an assembled program stand for, and which texels a pass over such a region has to draw. Plain
// arithmetic; it knows no texture.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace sk::assemble {

/// x fastest, that is, a C++ shape reversed.
using Index4 = std::array<std::int32_t, 4>;

/// A region of a stream. Plane: element (x, y) of the stream is texel (x, y). Linear: element number
/// n, row-major in the stream's whole shape, is texel (n & (1 << shift) - 1, n >> shift).
struct Placement {
  bool linear = false;
  bool view = false;             ///< less than the whole stream
  Index4 origin = {0, 0, 0, 0};  ///< first index of the region in its stream
  Index4 extent = {1, 1, 1, 1};  ///< shape of the region; missing dimensions 1
  Index4 stride = {1, 1, 1, 1};  ///< linear: stridesOf() the whole stream
  std::int32_t shift = 0;        ///< linear: log2 of the texture's width

  bool operator==(const Placement&) const = default;
};

/// Number of elements of the region.
std::int64_t elements(const Index4& extent);

/// Elements to step in each dimension of a whole stream of this shape {X, Y, Z, W}: {1, X, XY, XYZ}.
Index4 stridesOf(const Index4& extent);

/// How many dimensions of an index in the region can be other than 0: Variant::domainRank for it.
std::uint8_t decodedRank(const Placement& region);

/// log2 of the width of the near-square texture that holds `count` linearised elements: the smallest
/// power of two that is not below sqrt(count), but at most `textureLimit`.
std::int32_t linearShift(std::int64_t count, std::int32_t textureLimit);

/// A rectangle of texels.
struct Rect {
  std::int32_t x, y, width, height;
  bool operator==(const Rect&) const = default;
};

/// The rectangles that a pass over the region draws, one draw each, to write every element of it. They
/// hold no texel that is not an element of the stream, so that no kernel ever runs on what lies in
/// the unused end of a linearised texture. Empty where the region is; at most three.
std::vector<Rect> drawnTexels(const Placement& region);

}  // namespace sk::assemble
