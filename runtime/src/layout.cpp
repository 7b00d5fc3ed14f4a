// SPDX-License-Identifier: MIT
//
// From shapes to textures.
#include "layout.hpp"

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk {

namespace {

bool liesAsItIs(const Shape& shape, std::int32_t textureLimit) {
  if (shape.rank() > 2) {
    return false;
  }
  for (int d = 0; d < shape.rank(); ++d) {
    if (shape[d] > textureLimit) {
      return false;
    }
  }
  return true;
}

Layout linearised(const Shape& shape, std::int32_t textureLimit) {
  const std::int64_t count = shape.size();
  const std::int32_t shift = assemble::linearShift(count, textureLimit);
  const std::int64_t width = std::int64_t{1} << shift;
  const std::int64_t height = (count + width - 1) >> shift;
  if (height > textureLimit) {
    throw Error(
        fmt::format("a stream of shape {} has {} elements, but one texture of this device holds {} "
                    "({} x {} texels); divide it into several streams",
                    toString(shape), count, width * textureLimit, width, textureLimit));
  }
  Layout layout;
  layout.whole.linear = true;
  layout.whole.extent = xFirst(shape);
  layout.whole.stride = assemble::stridesOf(layout.whole.extent);
  layout.whole.shift = shift;
  layout.width = static_cast<std::int32_t>(width);
  layout.height = static_cast<std::int32_t>(height);
  return layout;
}

}  // namespace

assemble::Index4 xFirst(const Shape& shape) {
  assemble::Index4 extent{1, 1, 1, 1};
  for (int d = 0; d < shape.rank(); ++d) {
    extent[static_cast<std::size_t>(d)] = static_cast<std::int32_t>(shape[shape.rank() - 1 - d]);
  }
  return extent;
}

Layout layoutOf(const Shape& shape, std::int32_t textureLimit) {
  if (shape.rank() == 0) {
    throw Error("a stream needs a shape of 1 to 4 dimensions");
  }
  if (shape.size() == 0) {
    return {};
  }
  Layout layout;
  if (liesAsItIs(shape, textureLimit)) {
    layout.whole.extent = xFirst(shape);
    layout.width = layout.whole.extent[0];
    layout.height = layout.whole.extent[1];
  } else {
    layout = linearised(shape, textureLimit);
  }
  layout.draws = assemble::drawnTexels(layout.whole);
  return layout;
}

assemble::Placement placementOf(const StreamRegion& region, const Layout& layout) {
  assemble::Placement placement = layout.whole;
  const int rank = region.shape.rank();
  for (int d = 0; d < rank; ++d) {
    const auto axis = static_cast<std::size_t>(rank - 1 - d);
    const auto extent = static_cast<std::int32_t>(region.shape[d]);
    placement.origin[axis] = static_cast<std::int32_t>(region.begin[d]);
    placement.view = placement.view || extent != placement.extent[axis];
    placement.extent[axis] = extent;
  }
  return placement;
}

bool haveSameTexels(const assemble::Placement& a, const assemble::Placement& b) {
  return a.extent == b.extent && a.origin == b.origin && a.linear == b.linear &&
         (!a.linear || (a.shift == b.shift && a.stride == b.stride));
}

}  // namespace sk
