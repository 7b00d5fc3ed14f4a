// SPDX-License-Identifier: MIT
//
// A region as rectangles of texels whose elements are consecutive in host memory too: what goes to or
// comes from a texture in one piece. Plain arithmetic, no GL.
#pragma once

#include <algorithm>
#include <cstdint>

#include "assemble/region_layout.hpp"

namespace sk {

/// Texels of a rectangle, row by row, are the elements of the region from number `first` on.
struct CopyRegion {
  assemble::Rect rect;
  std::int64_t first;
};

/// Calls visit(part, layer, first) for the parts of a rectangle that lie in one layer each: `part` counts rows
/// in its layer, and `first` is its first row in the rectangle. `layerRows`: 0 where there are no layers.
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

/// A linearised region as runs of elements that are consecutive in the stream: `count` runs of
/// `length` elements each.
struct ElementRuns {
  explicit ElementRuns(const assemble::RegionLayout& region);

  /// Number in the stream of the first element of a run.
  std::int64_t start(std::int64_t run) const;

  std::int64_t count = 1;
  std::int64_t length = 1;

 private:
  const assemble::RegionLayout& region_;
  std::size_t axis_ = 0;  ///< the runs differ in this dimension and those above
};

/// Calls visit(const CopyRegion&) for consecutive elements `first ...` of a region that lie at numbers
/// `start ... start + length` of a linearised stream: at most a part of a row, full rows, a part.
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

/// Calls visit(const CopyRegion&) for pieces that together are the region, in order.
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

/// The rows of texels, whole, that a linearised region lies in.
assemble::Rect rowsOf(const assemble::RegionLayout& region);

}  // namespace sk
