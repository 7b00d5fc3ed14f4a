// SPDX-License-Identifier: MIT
//
// Implements the arithmetic of layouts.
#include "assemble/region_layout.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace sk::assemble {
namespace {

/// The rectangles that hold elements [begin, end) of a linearised stream: the rest of the first row, whole
/// rows, and the beginning of the last row.
std::vector<Rect> consecutiveTexels(std::int32_t begin, std::int32_t end, std::int32_t shift) {
  const std::int32_t width = 1 << shift;
  std::vector<Rect> rects;
  while (begin < end) {
    const std::int32_t x = begin & (width - 1);
    const std::int32_t y = begin >> shift;
    const std::int32_t left = end - begin;
    const bool wholeRows = x == 0 && left >= width;
    const Rect rect = wholeRows ? Rect{0, y, width, left >> shift} : Rect{x, y, std::min(width - x, left), 1};
    rects.push_back(rect);
    begin += rect.width * rect.height;
  }
  return rects;
}

/// The rectangles that hold a strided region, which is not packed, and what lies between its elements.
std::vector<Rect> texelsAround(const RegionLayout& region) {
  const Index4& origin = region.origin;
  const auto reach = [&](std::size_t d) { return (region.extent[d] - 1) * region.stride[d]; };
  if (!region.linear && !region.numbered) return {{origin[0], origin[1], reach(0) + 1, reach(1) + 1}};
  std::int32_t last = origin[0];
  for (std::size_t d = 0; d < region.extent.size(); ++d) last += region.extent[d] > 1 ? reach(d) : 0;
  if (region.linear) return consecutiveTexels(origin[0], last + 1, region.shift);
  const std::int32_t firstRow = origin[0] / region.shift;
  return {{0, firstRow, region.shift, last / region.shift - firstRow + 1}};
}

}  // namespace

std::int64_t elements(const Index4& extent) {
  std::int64_t count = 1;
  for (const std::int32_t n : extent) count *= n;
  return count;
}

Index4 stridesOf(const Index4& extent) {
  return {1, extent[0], extent[0] * extent[1], extent[0] * extent[1] * extent[2]};
}

bool isWholeTexels(const RegionLayout& region) {
  const bool areRowsWhole = !region.linear || decodedRank(region) == 1 || region.stride[1] % lanes == 0;
  return !region.strided && areRowsWhole && region.origin[0] % lanes == 0 && region.extent[0] % lanes == 0;
}

RegionLayout texelsOf(const RegionLayout& region) {
  assert(region.packed && isWholeTexels(region));
  RegionLayout texels = region;
  texels.packed = false;
  texels.origin[0] /= lanes;
  texels.extent[0] /= lanes;
  for (std::size_t d = 1; region.linear && d < texels.stride.size(); ++d) texels.stride[d] /= lanes;
  return texels;
}

std::uint8_t decodedRank(const RegionLayout& region) {
  std::uint8_t rank = 4;
  while (rank > 1 && region.origin[rank - 1u] + region.extent[rank - 1u] <= 1) --rank;
  return rank;
}

std::optional<TextureShape> linearTexture(std::int64_t count, const TextureLimits& limits) {
  assert(count > 0 && limits.size > 0);
  if (count > mostElements) return std::nullopt;
  const auto divideUp = [&](int shift) { return static_cast<std::int32_t>(((count - 1) >> shift) + 1); };
  constexpr int narrowest = 7;
  const int widest = std::bit_width(static_cast<std::uint32_t>(limits.size)) - 1;
  int square = 0;
  while (square < widest && std::int64_t{1} << (2 * square) < count) ++square;
  int shift = limits.isNarrow ? std::min(square, narrowest) : square;
  while (shift < square && divideUp(shift) > limits.size) ++shift;
  if (divideUp(shift) <= limits.size) return TextureShape{1 << shift, divideUp(shift), 0};
  const auto unused = [&] { return (std::int64_t{divideUp(2 * shift)} << (2 * shift)) - count; };
  while (unused() > count / 8 && divideUp(2 * (shift - 1)) <= limits.layers) --shift;
  if (divideUp(2 * shift) > limits.layers) return std::nullopt;
  return TextureShape{1 << shift, 1 << shift, divideUp(2 * shift)};
}

RegionLayout linearLayout(std::int64_t count, const TextureShape& texture) {
  RegionLayout regionLayout;
  regionLayout.linear = true;
  regionLayout.layered = texture.layers > 0;
  regionLayout.extent = {static_cast<std::int32_t>(count), 1, 1, 1};
  regionLayout.stride = stridesOf(regionLayout.extent);
  regionLayout.shift = std::bit_width(static_cast<std::uint32_t>(texture.width)) - 1;
  return regionLayout;
}

bool drawsWholeQuads(const RegionLayout& region) {
  if (region.packed) return drawsWholeQuads(texelsOf(region));
  if (region.strided) return false;
  const auto isEven = [](std::int32_t number) { return number % 2 == 0; };
  if (region.linear) {
    return !region.view && !region.layered &&
           elements(region.extent) % (std::int64_t{2} << region.shift) == 0;
  }
  return isEven(region.origin[0]) && isEven(region.origin[1]) && isEven(region.extent[0]) &&
         isEven(region.extent[1]);
}

std::vector<Rect> drawnTexels(const RegionLayout& region) {
  if (elements(region.extent) == 0) return {};
  if (region.strided) return texelsAround(region);
  if (region.packed) return drawnTexels(texelsOf(region));
  if (!region.linear) {
    return {{region.origin[0], region.origin[1], region.extent[0], region.extent[1]}};
  }
  std::int32_t first = 0;
  std::int32_t last = 0;
  for (std::size_t d = 0; d < region.extent.size(); ++d) {
    first += region.origin[d] * region.stride[d];
    last += (region.origin[d] + region.extent[d] - 1) * region.stride[d];
  }
  return consecutiveTexels(first, last + 1, region.shift);
}

}  // namespace sk::assemble
