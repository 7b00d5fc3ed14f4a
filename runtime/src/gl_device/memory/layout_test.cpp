// SPDX-License-Identifier: MIT
#include "gl_device/memory/layout.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/error.hpp"
#include "sk/limits.hpp"

using sk::Error;
using sk::haveSameTexels;
using sk::Index;
using sk::Layout;
using sk::layoutOf;
using sk::mostElements;
using sk::regionLayoutOf;
using sk::Shape;
using sk::StreamRegion;
using sk::assemble::Index4;
using sk::assemble::Rect;
using sk::assemble::RegionLayout;
using sk::assemble::TextureShape;

TEST_CASE("ranks 1 and 2 lie as they are where they fit") {
  const Layout plane = layoutOf({3, 5}, {64, 256});
  CHECK_FALSE(plane.whole.linear);
  CHECK(plane.texture.width == 5);
  CHECK(plane.texture.height == 3);
  CHECK(plane.whole.extent == Index4{5, 3, 1, 1});
  CHECK(plane.draws == std::vector<Rect>{{0, 0, 5, 3}});
  const Layout line = layoutOf(64, {64, 256});
  CHECK_FALSE(line.whole.linear);
  CHECK(line.texture.width == 64);
  CHECK(line.texture.height == 1);
}

TEST_CASE("all others are linearised to a power of two near the square root") {
  const Layout line = layoutOf(1000, {64, 256});
  CHECK(line.whole.linear);
  CHECK(line.texture.width == 32);
  CHECK(line.texture.height == 32);
  CHECK(line.whole.shift == 5);
  CHECK(line.draws == std::vector<Rect>{{0, 0, 32, 31}, {0, 31, 8, 1}});
  const Layout box = layoutOf({2, 3, 4}, {16384, 256});
  CHECK(box.whole.linear);
  CHECK(box.whole.extent == Index4{4, 3, 2, 1});
  CHECK(box.whole.stride == Index4{1, 4, 12, 24});
  CHECK(box.texture.width == 8);
  CHECK(box.texture.height == 3);
  CHECK(layoutOf({65, 2}, {64, 256}).whole.linear);
  CHECK(layoutOf({2, 65}, {64, 256}).whole.linear);
  CHECK(layoutOf({1, 1, 1}, {64, 256}).texture.width == 1);
}

TEST_CASE("nothing has no texture, too much no layout") {
  CHECK(layoutOf(0, {64, 256}).texture.width == 0);
  CHECK(layoutOf({5, 0}, {64, 256}).draws.empty());
  CHECK(layoutOf({std::int64_t{1} << 40, 0}, {64, 256}).texture.width == 0);
  CHECK_THROWS_AS(layoutOf(64 * 64 * 256 + 1, {64, 256}), sk::Error);
  CHECK_THROWS_AS(layoutOf({1 << 20, 1 << 20, 1 << 20}, {16384, 256}), sk::Error);
  CHECK_THROWS_AS(layoutOf(std::int64_t{1} << 31, {16384, 2048}), sk::Error);
  CHECK_THROWS_AS(layoutOf(Shape(), {64, 256}), sk::Error);
}

TEST_CASE("what one texture does not hold lies in layers") {
  CHECK(layoutOf(4096, {64, 256}).texture == TextureShape{64, 64, 0});
  const Layout layered = layoutOf({13, 17, 23}, {32, 256});   // 5083 elements
  CHECK(layered.texture == TextureShape{32, 32, 5});
  CHECK(layered.whole.layered);
  CHECK(layered.whole.shift == 5);
  CHECK(layered.whole.extent == Index4{23, 17, 13, 1});
  CHECK(layered.draws == std::vector<Rect>{{0, 0, 32, 158}, {0, 158, 27, 1}});
  CHECK(layoutOf(64 * 64 * 256, {64, 256}).texture == TextureShape{64, 64, 256});
  CHECK(layoutOf(mostElements, {16384, 256}).texture == TextureShape{16384, 16384, 8});
  CHECK_THROWS_AS(layoutOf(mostElements + 1, {16384, 256}), Error);
}

TEST_CASE("layers leave at most an eighth of their texels unused, where they may be as many") {
  for (std::int64_t count = 4097; count < 40000; count += 97) {
    const TextureShape texture = layoutOf(count, {64, 2048}).texture;
    const std::int64_t texels = std::int64_t{texture.width} * texture.height * texture.layers;
    REQUIRE(texels >= count);
    REQUIRE(texels - count <= count / 8);
  }
  CHECK(layoutOf(4097, {64, 2}).texture == TextureShape{64, 64, 2});
}

TEST_CASE("a limit that is no power of two") {
  CHECK(layoutOf(1216, {38, 256}).texture == TextureShape{32, 38, 0});
  CHECK(layoutOf(1217, {38, 256}).texture == TextureShape{16, 16, 5});
}

TEST_CASE("regions of a layout") {
  const Layout layout = layoutOf({10, 20}, {64, 256});
  const StreamRegion part{nullptr, Index(2, 3), Shape(4, 5)};
  const RegionLayout regionLayout = regionLayoutOf(part, layout);
  CHECK(regionLayout.view);
  CHECK(regionLayout.origin == Index4{3, 2, 0, 0});
  CHECK(regionLayout.extent == Index4{5, 4, 1, 1});
  CHECK_FALSE(regionLayoutOf({nullptr, Index(0, 0), Shape(10, 20)}, layout).view);
}

TEST_CASE("which regions have the same texels") {
  const auto region = [](const Index& begin, const Shape& shape) {
    return StreamRegion{nullptr, begin, shape};
  };
  const Layout small = layoutOf({10, 20}, {64, 256});
  const Layout large = layoutOf({30, 40}, {64, 256});
  CHECK(haveSameTexels(regionLayoutOf(region({0, 0}, {10, 20}), small),
                       regionLayoutOf(region({0, 0}, {10, 20}), large)));
  CHECK(haveSameTexels(regionLayoutOf(region({1, 2}, {3, 4}), small),
                       regionLayoutOf(region({1, 2}, {3, 4}), large)));
  CHECK_FALSE(haveSameTexels(regionLayoutOf(region({1, 2}, {3, 4}), small),
                             regionLayoutOf(region({1, 3}, {3, 4}), large)));
  CHECK_FALSE(haveSameTexels(regionLayoutOf(region({0, 0}, {1, 20}), small),
                             regionLayoutOf(region({0, 0}, {10, 20}), small)));
  const Layout cube = layoutOf({4, 5, 6}, {64, 256});
  const Layout taller = layoutOf({5, 5, 6}, {64, 256});
  const Layout wider = layoutOf({4, 5, 7}, {64, 256});
  CHECK(haveSameTexels(regionLayoutOf(region({1, 1, 1}, {2, 2, 2}), cube),
                       regionLayoutOf(region({1, 1, 1}, {2, 2, 2}), cube)));
  CHECK_FALSE(haveSameTexels(regionLayoutOf(region({1, 1, 1}, {2, 2, 2}), cube),
                             regionLayoutOf(region({1, 1, 1}, {2, 2, 2}), wider)));
  CHECK_FALSE(haveSameTexels(regionLayoutOf(region({1, 1, 1}, {2, 2, 2}), cube),
                             regionLayoutOf(region({1, 1, 1}, {2, 2, 2}), taller)));
}

namespace {

/// The texel of element `index` of a region, as programs compute it: {x, y}, rows of layers after each other.
std::array<std::int64_t, 2> texelAt(const RegionLayout& region, const Index4& index) {
  const auto at = [&](std::size_t d) { return std::int64_t{index[d]}; };
  if (!region.linear && !region.numbered) {
    if (!region.strided) return {region.origin[0] + at(0), region.origin[1] + at(1)};
    return {region.origin[0] + at(0) * region.stride[0], region.origin[1] + at(1) * region.stride[1]};
  }
  std::int64_t number = region.strided ? region.origin[0] : 0;
  for (std::size_t d = 0; d < index.size(); ++d)
    number += (at(d) + (region.strided ? 0 : region.origin[d])) * region.stride[d];
  if (region.numbered) return {number % region.shift, number / region.shift};
  return {number & ((1 << region.shift) - 1), number >> region.shift};
}

}  // namespace

TEST_CASE("regions with strides are where their elements are") {
  struct Case {
    Shape stream;
    StreamRegion region;
    bool isStrided, isNumbered;
  };
  const Case cases[] = {
      {{6, 8}, {nullptr, {}, Shape(3, 4), Index(16, 2), 9}, true, false},
      {{6, 8}, {nullptr, {}, Shape(8), Index(1), 16}, false, false},  // a row
      {{6, 8}, {nullptr, {}, Shape(6), Index(8), 3}, true, true},  // a column
      {{6, 8}, {nullptr, {}, Shape(48), Index(1), 0}, true, true},
      {{6, 8}, {nullptr, {}, Shape(2, 2, 2), Index(16, 8, 3), 1}, true, true},
      {{1200}, {nullptr, {}, Shape(30, 40), Index(40, 1), 0}, false, false},
      {{1200}, {nullptr, {}, Shape(28, 36), Index(36, 1), 192}, true, false},  // rows that cross the shape's
      {{1200}, {nullptr, {}, Shape(4, 36), Index(36, 1), 180}, false, false},
      {{1200}, {nullptr, {}, Shape(5, 1, 40), Index(40, 1, 1), 80}, false, false},
      {{1200}, {nullptr, {}, Shape(20, 20), Index(60, 3), 1}, true, false},
      {{30, 5, 8}, {nullptr, {}, Shape(15, 5, 4), Index(80, 8, 2), 40}, true, false},
  };
  for (const Case& one : cases) {
    INFO(sk::toString(one.stream) << " as " << sk::toString(one.region.shape));
    const Layout layout = layoutOf(one.stream, {64, 256});
    const RegionLayout region = regionLayoutOf(one.region, layout);
    CHECK(region.strided == one.isStrided);
    CHECK(region.numbered == one.isNumbered);
    const Shape& shape = one.region.shape;
    for (std::int64_t n = 0; n < shape.size(); ++n) {
      Index4 index{};
      std::int64_t rest = n, number = one.region.first;
      for (int d = shape.rank() - 1; d >= 0; --d) {
        index[static_cast<std::size_t>(shape.rank() - 1 - d)] = static_cast<std::int32_t>(rest % shape[d]);
        number += rest % shape[d] * one.region.stride[d];
        rest /= shape[d];
      }
      const std::int64_t width = layout.texture.width;
      CHECK(texelAt(region, index) == std::array<std::int64_t, 2>{number % width, number / width});
    }
    const std::vector<Rect> drawn = sk::assemble::drawnTexels(region);
    const auto isDrawn = [&](const std::array<std::int64_t, 2>& texel) {
      return std::ranges::any_of(drawn, [&](const Rect& rect) {
        return texel[0] >= rect.x && texel[0] < rect.x + rect.width && texel[1] >= rect.y &&
               texel[1] < rect.y + rect.height;
      });
    };
    CHECK(isDrawn(texelAt(region, {})));
    Index4 last{};
    for (std::size_t d = 0; d < last.size(); ++d) last[d] = region.extent[d] - 1;
    CHECK(isDrawn(texelAt(region, last)));
  }
}

TEST_CASE("a gather of a part of a whole has the whole's extents, and wraps from a first index near 0") {
  using sk::program::Boundary;
  const RegionLayout held = layoutOf({6, 8}, {64, 256}).whole;
  const RegionLayout clamped = sk::gatherLayout(held, {{-2, 100}, {50, 104}}, Boundary::Clamp);
  CHECK(clamped.placed);
  CHECK(clamped.extent == Index4{104, 50, 1, 1});
  CHECK(clamped.origin == Index4{-100, 2, 0, 0});
  CHECK(clamped.place.low == Index4{100, 0, 0, 0});
  CHECK(clamped.place.high == Index4{104, 4, 1, 1});
  const RegionLayout wrapped = sk::gatherLayout(held, {{-2, 100}, {50, 104}}, Boundary::Wrap);
  CHECK(wrapped.origin == Index4{4, 2, 0, 0});
  CHECK(wrapped.place.low == Index4{-4, -2, 0, 0});
  CHECK(wrapped.place.high == Index4{4, 4, 1, 1});
}

TEST_CASE("a local gather keeps the part's extents, and knows where in it the domain begins") {
  const RegionLayout held = layoutOf({6, 8}, {64, 256}).whole;
  const RegionLayout local = sk::localLayout(held, {{-2, 100}, {50, 104}}, {3, 100});
  CHECK(local.placed);
  CHECK(local.local);
  CHECK(local.extent == held.extent);
  CHECK(local.origin == held.origin);
  CHECK(local.place.low == Index4{0, 5, 0, 0});
  CHECK(local.place.whole == Index4{104, 50, 1, 1});
}
