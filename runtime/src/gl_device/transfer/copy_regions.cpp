// SPDX-License-Identifier: MIT
#include "gl_device/transfer/copy_regions.hpp"

namespace sk {

// Runs extend over a dimension if the region covers the lower dimensions of its stream entirely.
ElementRuns::ElementRuns(const assemble::RegionLayout& region) : region_(region) {
  const std::size_t rank = region.extent.size();
  length = region.extent[0];
  for (axis_ = 1; axis_ < rank && length == region.stride[axis_]; ++axis_) {
    length *= region.extent[axis_];
  }
  for (std::size_t axis = axis_; axis < rank; ++axis) {
    count *= region.extent[axis];
  }
}

std::int64_t ElementRuns::start(std::int64_t run) const {
  std::int64_t number = 0;
  for (std::size_t axis = 0; axis < region_.extent.size(); ++axis) {
    std::int64_t index = region_.origin[axis];
    if (axis >= axis_) {
      index += run % region_.extent[axis];
      run /= region_.extent[axis];
    }
    number += index * region_.stride[axis];
  }
  return number;
}

assemble::Rect rowsOf(const assemble::RegionLayout& region) {
  const ElementRuns runs(region);
  const std::int64_t first = runs.start(0) >> region.shift;
  const std::int64_t last = (runs.start(runs.count - 1) + runs.length - 1) >> region.shift;
  return {0, static_cast<std::int32_t>(first), std::int32_t{1} << region.shift,
          static_cast<std::int32_t>(last - first + 1)};
}

}  // namespace sk
