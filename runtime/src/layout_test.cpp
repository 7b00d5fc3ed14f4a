// SPDX-License-Identifier: MIT
#include "layout.hpp"

#include <catch2/catch.hpp>

#include "sk/error.hpp"

using sk::haveSameTexels;
using sk::Index;
using sk::Layout;
using sk::layoutOf;
using sk::Shape;
using sk::StreamRegion;
using sk::assemble::Index4;
using sk::assemble::Placement;
using sk::assemble::Rect;

TEST_CASE("ranks 1 and 2 lie as they are where they fit") {
  const Layout plane = layoutOf({3, 5}, 64);
  CHECK_FALSE(plane.whole.linear);
  CHECK(plane.width == 5);
  CHECK(plane.height == 3);
  CHECK(plane.whole.extent == Index4{5, 3, 1, 1});
  CHECK(plane.draws == std::vector<Rect>{{0, 0, 5, 3}});
  const Layout line = layoutOf(64, 64);
  CHECK_FALSE(line.whole.linear);
  CHECK(line.width == 64);
  CHECK(line.height == 1);
}

TEST_CASE("all others are linearised to a power of two near the square root") {
  const Layout line = layoutOf(1000, 64);
  CHECK(line.whole.linear);
  CHECK(line.width == 32);
  CHECK(line.height == 32);
  CHECK(line.whole.shift == 5);
  CHECK(line.draws == std::vector<Rect>{{0, 0, 32, 31}, {0, 31, 8, 1}});
  const Layout box = layoutOf({2, 3, 4}, 16384);
  CHECK(box.whole.linear);
  CHECK(box.whole.extent == Index4{4, 3, 2, 1});
  CHECK(box.whole.stride == Index4{1, 4, 12, 24});
  CHECK(box.width == 8);
  CHECK(box.height == 3);
  CHECK(layoutOf({65, 2}, 64).whole.linear);
  CHECK(layoutOf({2, 65}, 64).whole.linear);
  CHECK(layoutOf({1, 1, 1}, 64).width == 1);
}

TEST_CASE("nothing has no texture, too much no layout") {
  CHECK(layoutOf(0, 64).width == 0);
  CHECK(layoutOf({5, 0}, 64).draws.empty());
  CHECK(layoutOf({std::int64_t{1} << 40, 0}, 64).width == 0);
  CHECK(layoutOf(4096, 64).height == 64);
  CHECK_THROWS_AS(layoutOf(4097, 64), sk::Error);
  CHECK_THROWS_AS(layoutOf({1 << 20, 1 << 20, 1 << 20}, 16384), sk::Error);
  CHECK_THROWS_AS(layoutOf(Shape(), 64), sk::Error);
}

TEST_CASE("a limit that is no power of two") {
  CHECK(layoutOf(1216, 38).width == 32);
  CHECK(layoutOf(1216, 38).height == 38);
  CHECK_THROWS_AS(layoutOf(1217, 38), sk::Error);
}

TEST_CASE("regions of a layout") {
  const Layout layout = layoutOf({10, 20}, 64);
  const StreamRegion part{nullptr, Index(2, 3), Shape(4, 5)};
  const Placement placement = placementOf(part, layout);
  CHECK(placement.view);
  CHECK(placement.origin == Index4{3, 2, 0, 0});
  CHECK(placement.extent == Index4{5, 4, 1, 1});
  CHECK_FALSE(placementOf({nullptr, Index(0, 0), Shape(10, 20)}, layout).view);
}

TEST_CASE("which regions have the same texels") {
  const auto region = [](const Index& begin, const Shape& shape) {
    return StreamRegion{nullptr, begin, shape};
  };
  const Layout small = layoutOf({10, 20}, 64);
  const Layout large = layoutOf({30, 40}, 64);
  CHECK(haveSameTexels(placementOf(region({0, 0}, {10, 20}), small),
                       placementOf(region({0, 0}, {10, 20}), large)));
  CHECK(
      haveSameTexels(placementOf(region({1, 2}, {3, 4}), small), placementOf(region({1, 2}, {3, 4}), large)));
  CHECK_FALSE(
      haveSameTexels(placementOf(region({1, 2}, {3, 4}), small), placementOf(region({1, 3}, {3, 4}), large)));
  CHECK_FALSE(haveSameTexels(placementOf(region({0, 0}, {1, 20}), small),
                             placementOf(region({0, 0}, {10, 20}), small)));
  const Layout cube = layoutOf({4, 5, 6}, 64);
  const Layout taller = layoutOf({5, 5, 6}, 64);
  const Layout wider = layoutOf({4, 5, 7}, 64);
  CHECK(haveSameTexels(placementOf(region({1, 1, 1}, {2, 2, 2}), cube),
                       placementOf(region({1, 1, 1}, {2, 2, 2}), cube)));
  CHECK_FALSE(haveSameTexels(placementOf(region({1, 1, 1}, {2, 2, 2}), cube),
                             placementOf(region({1, 1, 1}, {2, 2, 2}), wider)));
  CHECK_FALSE(haveSameTexels(placementOf(region({1, 1, 1}, {2, 2, 2}), cube),
                             placementOf(region({1, 1, 1}, {2, 2, 2}), taller)));
}
