// SPDX-License-Identifier: MIT
//
// Divides a region into rectangles of texels whose elements are consecutive in row-major order, each of which
// one GL command per layer can transfer. Pure arithmetic, no GL.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "assemble/region_layout.hpp"

namespace sk {

/// A rectangle of texels: row by row, they hold the region's elements from number `first` on. If `first` is
/// `wholeRows`, the rectangle is rowsOf(region), and holds other elements as well.
struct CopyRegion {
  static constexpr std::int64_t wholeRows = -1;

  assemble::Rect rect;
  std::int64_t first;

  std::size_t texels() const {
    return static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
  }
};

/// Divides a rectangle, whose rows are numbered across layers, into parts that lie in one layer each. Calls
/// visit(part, layer, first): the rows of `part` are numbered in its layer, and `first` is its first row,
/// counted from the top of the rectangle. `layerRows` is 0 if there are no layers.
template <class Visit>
void forEachLayer(const assemble::Rect& rect, std::int32_t layerRows, Visit&& visit) {
  if (layerRows == 0) {
    visit(rect, 0, 0);
    return;
  }
  for (std::int32_t first = 0; first < rect.height;) {
    const std::int32_t layer = (rect.y + first) / layerRows;
    const std::int32_t y = rect.y + first - layer * layerRows;
    const std::int32_t height = std::min(rect.height - first, layerRows - y);
    visit(assemble::Rect{rect.x, y, rect.width, height}, layer, first);
    first += height;
  }
}

/// A linearised region as `count` runs of `length` elements each, which are consecutive in the stream.
struct ElementRuns {
  explicit ElementRuns(const assemble::RegionLayout& region);

  /// The number of a run's first element in the stream.
  std::int64_t start(std::int64_t run) const;

  std::int64_t count = 1;
  std::int64_t length = 1;

 private:
  const assemble::RegionLayout& region_;
  std::size_t axis_ = 0;  ///< the first dimension over which runs do not extend
};

/// Divides a run into rectangles: at most a part of a row, full rows, and a part of a row. The run's elements
/// have the numbers `start` to `start + length - 1` in a linearised stream, and numbers from `first` on in
/// the region. Calls visit(const CopyRegion&) for each.
template <class Visit>
void splitRun(std::int32_t shift, std::int64_t start, std::int64_t length, std::int64_t first,
              Visit&& visit) {
  const std::int64_t width = std::int64_t{1} << shift;
  while (length > 0) {
    const std::int64_t x = start & (width - 1);
    const std::int64_t rows = x == 0 ? length / width : 0;
    const std::int64_t across = rows > 0 ? width : std::min(length, width - x);
    const std::int64_t taken = rows > 0 ? rows * width : across;
    visit(CopyRegion{
        {static_cast<std::int32_t>(x), static_cast<std::int32_t>(start >> shift),
         static_cast<std::int32_t>(across), static_cast<std::int32_t>(std::max<std::int64_t>(rows, 1))},
        first});
    start += taken;
    first += taken;
    length -= taken;
  }
}

/// Calls visit(const CopyRegion&) for rectangles that cover the region, in order.
template <class Visit>
void forEachCopyRegion(const assemble::RegionLayout& region, Visit&& visit) {
  if (!region.linear) {
    visit(CopyRegion{{region.origin[0], region.origin[1], region.extent[0], region.extent[1]}, 0});
    return;
  }
  const ElementRuns runs(region);
  for (std::int64_t run = 0; run < runs.count; ++run) {
    splitRun(region.shift, runs.start(run), runs.length, run * runs.length, visit);
  }
}

/// The whole rows of texels that contain a linearised region.
assemble::Rect rowsOf(const assemble::RegionLayout& region);

/// Calls visit(const CopyRegion&) for the rows that contain a linearised region, or for rectangles that cover
/// the region.
template <class Visit>
void forEachCopyRegion(const assemble::RegionLayout& region, bool byRows, Visit&& visit) {
  if (byRows) {
    visit(CopyRegion{rowsOf(region), CopyRegion::wholeRows});
  } else {
    forEachCopyRegion(region, visit);
  }
}

}  // namespace sk
