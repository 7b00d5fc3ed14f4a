// SPDX-License-Identifier: MIT
#include "gl_device/memory/layout.hpp"

#include <optional>
#include <string_view>

#include <fmt/format.h>

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

assemble::RegionLayout regionLayoutOf(const StreamRegion& region, const Layout& layout) {
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

bool haveSameTexels(const assemble::RegionLayout& a, const assemble::RegionLayout& b) {
  if (&a == &b) return true;  // an output whose region layout is the domain itself
  return a.extent == b.extent && a.origin == b.origin && a.linear == b.linear && a.packed == b.packed &&
         a.layered == b.layered && (!a.linear || (a.shift == b.shift && a.stride == b.stride));
}

}  // namespace sk
