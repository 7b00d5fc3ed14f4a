// SPDX-License-Identifier: MIT
//
// Arithmetic of layouts.
#include "assemble/placement.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace sk::assemble {
namespace {

/// The rectangles that hold elements [begin, end) of a linearised stream: the rest of a row that is
/// begun, whole rows, and the beginning of a last one.
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

}  // namespace

std::int64_t elements(const Index4& extent) {
  std::int64_t count = 1;
  for (const std::int32_t n : extent) count *= n;
  return count;
}

Index4 stridesOf(const Index4& extent) {
  return {1, extent[0], extent[0] * extent[1], extent[0] * extent[1] * extent[2]};
}

std::uint8_t decodedRank(const Placement& region) {
  std::uint8_t rank = 4;
  while (rank > 1 && region.origin[rank - 1u] + region.extent[rank - 1u] <= 1) --rank;
  return rank;
}

std::int32_t linearShift(std::int64_t count, std::int32_t textureLimit) {
  assert(textureLimit > 0);
  const int limit = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(textureLimit))) - 1;
  std::int32_t shift = 0;
  while (shift < limit && std::int64_t{1} << (2 * shift) < count) ++shift;
  return shift;
}

std::vector<Rect> drawnTexels(const Placement& region) {
  if (elements(region.extent) == 0) return {};
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
