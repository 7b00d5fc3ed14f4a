// SPDX-License-Identifier: MIT
#include "gl_device/memory/layout.hpp"

#include <catch2/catch.hpp>

#include "sk/error.hpp"
#include "sk/limits.hpp"

using sk::Error;
using sk::haveSameTexels;
using sk::Index;
using sk::Layout;
using sk::layoutOf;
using sk::mostElements;
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
