// SPDX-License-Identifier: MIT
#include "gl_device/memory/layout.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "device/region.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

/// The longest 1-D stream that is not linearised. Its texture is one texel high, and a device that processes
/// squares of texels wastes most of each square.
constexpr std::int64_t longestRow = 256;

bool fitsTexture(const Shape& shape, std::int32_t longest) {
  if (shape.rank() > 2 || (shape.rank() == 1 && shape[0] > longestRow)) {
    return false;
  }
  for (int d = 0; d < shape.rank(); ++d) {
    if (shape[d] > longest) {
      return false;
    }
  }
  return true;
}

/// The texture of `count` linearised elements, at least 1. Throws sk::Error, about `what`, if there is none.
assemble::TextureShape textureOf(std::int64_t count, const assemble::TextureLimits& limits,
                                 std::string_view what, std::string_view advice) {
  const std::optional<assemble::TextureShape> texture = assemble::linearTexture(count, limits);
  if (!texture) {
    throw Error(
        fmt::format("{} has {} elements, but a texture of this device holds no more than {} layers of "
                    "{} x {} texels, and a stream {} elements; {}",
                    what, count, limits.layers, limits.size, limits.size, mostElements, advice),
        Error::Kind::Shape);
  }
  return *texture;
}

Layout linearised(const Shape& shape, const assemble::TextureLimits& limits) {
  Layout layout;
  layout.texture = textureOf(shape.size(), limits, fmt::format("a stream of shape {}", toString(shape)),
                             "divide it into several streams");
  layout.whole = assemble::linearLayout(shape.size(), layout.texture);
  layout.whole.extent = xFirst(shape);
  layout.whole.stride = assemble::stridesOf(layout.whole.extent);
  return layout;
}

/// The layout of a stream of texels with four elements each, but with the extents and strides of elements.
Layout packedLayout(const Shape& shape, const assemble::TextureLimits& limits) {
  const int last = shape.rank() - 1;
  Layout layout = layoutOf(shape.with(last, shape[last] / assemble::lanes), limits);
  layout.whole.packed = true;
  layout.whole.extent = xFirst(shape);
  if (layout.whole.linear) {
    layout.whole.stride = assemble::stridesOf(layout.whole.extent);
  }
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

assemble::Index4 xFirst(const Index& index) {
  assemble::Index4 result{0, 0, 0, 0};
  for (int d = 0; d < index.rank(); ++d)
    result[static_cast<std::size_t>(d)] = static_cast<std::int32_t>(index[index.rank() - 1 - d]);
  return result;
}

assemble::RegionLayout gatherLayout(const assemble::RegionLayout& region, const Placement& placement,
                                    program::Boundary boundary) {
  assemble::RegionLayout gather = region;
  gather.placed = true;
  gather.extent = xFirst(placement.whole);
  const assemble::Index4 origin = xFirst(placement.origin);
  for (std::size_t d = 0; d < origin.size(); ++d) {
    const std::int32_t n = gather.extent[d];
    std::int32_t low = origin[d];
    if (boundary == program::Boundary::Wrap) low = (low % n - n) % n;  // above -n and at most 0
    gather.origin[d] -= low;
    std::int32_t high = low + region.extent[d];
    if (boundary != program::Boundary::Wrap) {
      low = std::max(low, 0);
      high = std::min(high, n);
    }
    gather.place.low[d] = low;
    gather.place.high[d] = high;
  }
  gather.place.whole = gather.extent;
  return gather;
}

assemble::RegionLayout localLayout(const assemble::RegionLayout& region, const Placement& placement,
                                   const Index& domain) {
  assemble::RegionLayout gather = region;
  gather.placed = gather.local = true;
  gather.place.whole = xFirst(placement.whole);
  const assemble::Index4 first = xFirst(domain), origin = xFirst(placement.origin);
  for (int d = 0; d < placement.origin.rank(); ++d) {
    const auto axis = static_cast<std::size_t>(d);
    gather.place.low[axis] = first[axis] - origin[axis];
  }
  return gather;
}

Layout layoutOf(const Shape& shape, const assemble::TextureLimits& limits, bool packed) {
  if (shape.rank() == 0) {
    throw Error("a stream needs a shape of 1 to 4 dimensions", Error::Kind::Shape);
  }
  if (shape.size() == 0) {
    return {};
  }
  if (packed && shape.size() <= mostElements) {
    return packedLayout(shape, limits);
  }
  Layout layout;
  if (fitsTexture(shape, limits.size)) {
    layout.whole.extent = xFirst(shape);
    layout.texture = {layout.whole.extent[0], layout.whole.extent[1]};
  } else {
    layout = linearised(shape, limits);
  }
  layout.draws = assemble::drawnTexels(layout.whole);
  return layout;
}

bool mayPack(const Shape& shape) {
  return shape.size() > 0 && shape[shape.rank() - 1] % assemble::lanes == 0;
}

Layout listLayout(std::int64_t length, const assemble::TextureLimits& limits) {
  Layout layout;
  if (length > 0) {
    layout.texture = textureOf(length, limits, "what a kernel pushes or scatters", "divide the domain");
  }
  layout.whole = assemble::linearLayout(length, length > 0 ? layout.texture : assemble::TextureShape{1, 0});
  layout.draws = assemble::drawnTexels(layout.whole);
  return layout;
}

namespace {

/// A region of a plane with strides along its rows and columns; nullopt if it has others. Rows have `width` elements.
std::optional<assemble::RegionLayout> stridedPlane(const AffineRegion& region, assemble::RegionLayout plane,
                                                   std::int64_t width) {
  const std::int64_t x = region.first % width;
  const bool isOfRows = region.extent[1] == 1 || region.stride[1] % width == 0;
  if (region.extent[2] * region.extent[3] != 1 || !isOfRows ||
      x + (region.extent[0] - 1) * region.stride[0] >= width)
    return std::nullopt;
  plane.origin = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(region.first / width), 0, 0};
  plane.stride = {1, 1, 1, 1};
  if (region.extent[0] > 1) plane.stride[0] = static_cast<std::int32_t>(region.stride[0]);
  if (region.extent[1] > 1) plane.stride[1] = static_cast<std::int32_t>(region.stride[1] / width);
  plane.strided = plane.stride != assemble::Index4{1, 1, 1, 1};
  return plane;
}

/// A region of a linearised stream as a box in another shape; nullopt if it has gaps along x, or if its rows do not
/// begin at the same column of that shape.
std::optional<assemble::RegionLayout> boxInAnotherShape(const AffineRegion& region,
                                                        assemble::RegionLayout linear) {
  if (region.extent[0] > 1 && region.stride[0] != 1) return std::nullopt;
  linear.stride = {1, assemble::noStride, assemble::noStride, assemble::noStride};
  for (std::size_t d = 3; d > 0; --d) {  // a dimension of extent 1 is as far as the next one
    if (region.extent[d] > 1) {
      linear.stride[d] = static_cast<std::int32_t>(region.stride[d]);
    } else if (d < 3) {
      linear.stride[d] = linear.stride[d + 1];
    }
  }
  std::int64_t rest = region.first;
  for (std::size_t d = 4; d-- > 0;) {
    linear.origin[d] = static_cast<std::int32_t>(rest / linear.stride[d]);
    rest %= linear.stride[d];
    const std::int64_t end = (linear.origin[d] + region.extent[d]) * linear.stride[d];
    if (d < 3 && region.extent[d] > 1 && end > linear.stride[d + 1]) return std::nullopt;
  }
  return linear;
}

assemble::RegionLayout layoutWithStrides(const StreamRegion& region, const Layout& layout) {
  const AffineRegion all = affine(region);
  assemble::RegionLayout result = layout.whole;
  for (std::size_t d = 0; d < all.extent.size(); ++d)
    result.extent[d] = static_cast<std::int32_t>(all.extent[d]);
  result.view = region.shape.size() != assemble::elements(layout.whole.extent);
  if (result.linear && !result.view) {
    result.stride = assemble::stridesOf(result.extent);
    return result;
  }
  const std::int32_t width = layout.whole.extent[0];
  if (const auto box = result.linear ? boxInAnotherShape(all, result) : stridedPlane(all, result, width))
    return *box;
  result.strided = true;
  result.numbered = !result.linear;
  if (result.numbered) result.shift = width;
  result.origin = {static_cast<std::int32_t>(all.first), 0, 0, 0};
  for (std::size_t d = 0; d < all.extent.size(); ++d) {
    result.stride[d] = all.extent[d] > 1 ? static_cast<std::int32_t>(all.stride[d]) : assemble::noStride;
  }
  return result;
}

}  // namespace

assemble::RegionLayout regionLayoutOf(const StreamRegion& region, const Layout& layout) {
  if (!isBox(region)) return layoutWithStrides(region, layout);
  assemble::RegionLayout regionLayout = layout.whole;
  const int rank = region.shape.rank();
  for (int d = 0; d < rank; ++d) {
    const auto axis = static_cast<std::size_t>(rank - 1 - d);
    const auto extent = static_cast<std::int32_t>(region.shape[d]);
    regionLayout.origin[axis] = static_cast<std::int32_t>(region.begin[d]);
    regionLayout.view = regionLayout.view || extent != regionLayout.extent[axis];
    regionLayout.extent[axis] = extent;
  }
  return regionLayout;
}

assemble::RegionLayout partOf(const assemble::RegionLayout& region, int rank, const Box& box) {
  assemble::RegionLayout part = region;
  for (int d = 0; !box.isWhole() && d < rank; ++d) {
    const auto axis = static_cast<std::size_t>(rank - 1 - d);
    part.origin[axis] += static_cast<std::int32_t>(box.begin[d]);
    part.extent[axis] = static_cast<std::int32_t>(box.end[d] - box.begin[d]);
    part.view = part.view || part.extent[axis] != region.extent[axis];
  }
  return part;
}

bool haveSameTexels(const assemble::RegionLayout& a, const assemble::RegionLayout& b) {
  if (&a == &b) return true;  // an output whose region layout is the domain itself
  if (a.strided != b.strided || a.numbered != b.numbered || (a.strided && a.stride != b.stride)) return false;
  return a.extent == b.extent && a.origin == b.origin && a.linear == b.linear && a.packed == b.packed &&
         a.layered == b.layered && (!a.linear || (a.shift == b.shift && a.stride == b.stride));
}

}  // namespace sk
