// SPDX-License-Identifier: MIT
//
// Promises: a pass draws every element of the region exactly once, and only elements.
#include "assemble/region_layout.hpp"

#include <map>
#include <utility>

#include <catch2/catch.hpp>

using namespace sk::assemble;

namespace {

constexpr TextureLimits limits{64, 256};

RegionLayout linearStream(const Index4& extent) {
  RegionLayout regionLayout = linearLayout(elements(extent), *linearTexture(elements(extent), limits));
  regionLayout.extent = extent;
  regionLayout.stride = stridesOf(extent);
  return regionLayout;
}

std::int32_t widthOf(std::int64_t count, std::int32_t size, bool isNarrow = false) {
  return linearTexture(count, {size, 256, isNarrow})->width;
}

/// How often each texel is drawn.
std::map<std::pair<int, int>, int> drawn(const RegionLayout& region) {
  std::map<std::pair<int, int>, int> counts;
  for (const Rect& rect : drawnTexels(region)) {
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      for (int x = rect.x; x < rect.x + rect.width; ++x) ++counts[{x, y}];
    }
  }
  return counts;
}

}  // namespace

TEST_CASE("the texture of a linearised stream is as wide as a power of two, and not wider than it must be") {
  CHECK(widthOf(1, 8192) == 1);
  CHECK(widthOf(2, 8192) == 2);
  CHECK(widthOf(4, 8192) == 2);
  CHECK(widthOf(5, 8192) == 4);
  CHECK(widthOf(1 << 14, 8192) == 128);
  CHECK(widthOf(1 << 20, 8192) == 1024);
  CHECK(widthOf((1 << 20) + 1, 8192) == 2048);
  CHECK(widthOf(1 << 14, 8192, true) == 128);
  CHECK(widthOf(1 << 20, 8192, true) == 128);
  CHECK(widthOf((1 << 20) + 1, 8192, true) == 256);
  CHECK(widthOf(1 << 26, 8192, true) == 1 << 13);
  CHECK(widthOf(1 << 26, 8192) == 1 << 13);
  CHECK(widthOf(1 << 26, 10000) == 1 << 13);
  CHECK(linearTexture(1 << 26, {4096, 256}) == TextureShape{4096, 4096, 4});
  CHECK_FALSE(linearTexture(1 << 26, {4096, 3}));
  CHECK_FALSE(linearTexture(sk::mostElements + 1, {1 << 20, 256}));
}

TEST_CASE("a whole linearised stream draws its elements once and not the end of the last row") {
  for (int count = 1; count < 300; ++count) {
    const RegionLayout stream = linearStream({count, 1, 1, 1});
    const auto texels = drawn(stream);
    REQUIRE(drawnTexels(stream).size() <= 2);
    REQUIRE(static_cast<int>(texels.size()) == count);
    for (const auto& [texel, times] : texels) {
      REQUIRE(times == 1);
      REQUIRE(((texel.second << stream.shift) | texel.first) < count);
    }
  }
}

TEST_CASE("a box of a linearised stream draws the elements from its first to its last") {
  const RegionLayout whole = linearStream({5, 4, 3, 1});
  for (int first = 0; first < 60; ++first) {
    for (int last = first; last < 60; ++last) {
      RegionLayout region = whole;
      region.view = true;
      region.origin = {first % 5, first / 5 % 4, first / 20, 0};
      region.extent = {last % 5 - region.origin[0] + 1, last / 5 % 4 - region.origin[1] + 1,
                       last / 20 - region.origin[2] + 1, 1};
      if (region.extent[0] < 1 || region.extent[1] < 1 || region.extent[2] < 1) continue;
      const auto texels = drawn(region);
      REQUIRE(drawnTexels(region).size() <= 3);
      REQUIRE(static_cast<int>(texels.size()) == last - first + 1);
      REQUIRE(texels.count({first & 7, first >> 3}) == 1);
      REQUIRE(texels.count({last & 7, last >> 3}) == 1);
    }
  }
}

TEST_CASE("a plane draws its rectangle, and nothing where it is empty") {
  CHECK(drawnTexels({.view = true, .origin = {3, 4, 0, 0}, .extent = {10, 20, 1, 1}}) ==
        std::vector<Rect>{{3, 4, 10, 20}});
  CHECK(drawnTexels({.extent = {0, 20, 1, 1}}).empty());
  CHECK(drawnTexels({.linear = true, .extent = {3, 0, 1, 1}}).empty());
}

TEST_CASE("the decoded rank leaves out dimensions that stay 0") {
  CHECK(decodedRank(linearStream({7, 1, 1, 1})) == 1);
  CHECK(decodedRank(linearStream({1, 1, 1, 1})) == 1);
  CHECK(decodedRank(linearStream({7, 1, 3, 1})) == 3);
  CHECK(decodedRank(linearStream({1, 1, 1, 2})) == 4);
  CHECK(decodedRank({.linear = true, .view = true, .origin = {0, 2, 0, 0}, .extent = {3, 1, 1, 1}}) == 2);
}
