// SPDX-License-Identifier: MIT
//
// Which texels a pass draws: all elements of the region, each once, and nothing but elements.
#include "assemble/placement.hpp"

#include <map>
#include <utility>

#include <catch2/catch.hpp>

using namespace sk::assemble;

namespace {

Placement linearStream(const Index4& extent, std::int32_t limit = 64) {
  return {.linear = true,
          .extent = extent,
          .stride = stridesOf(extent),
          .shift = linearShift(elements(extent), limit)};
}

/// How often each texel is drawn.
std::map<std::pair<int, int>, int> drawn(const Placement& region) {
  std::map<std::pair<int, int>, int> counts;
  for (const Rect& rect : drawnTexels(region)) {
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      for (int x = rect.x; x < rect.x + rect.width; ++x) ++counts[{x, y}];
    }
  }
  return counts;
}

}  // namespace

TEST_CASE("the texture of a linearised stream is near-square and as wide as a power of two") {
  CHECK(linearShift(1, 8192) == 0);
  CHECK(linearShift(2, 8192) == 1);
  CHECK(linearShift(4, 8192) == 1);
  CHECK(linearShift(5, 8192) == 2);
  CHECK(linearShift(1 << 20, 8192) == 10);
  CHECK(linearShift((1 << 20) + 1, 8192) == 11);
  CHECK(linearShift(1 << 26, 8192) == 13);
  CHECK(linearShift(1 << 26, 10000) == 13);
  CHECK(linearShift(1 << 26, 4096) == 12);
}

TEST_CASE("a whole linearised stream draws its elements once and not the end of the last row") {
  for (int count = 1; count < 300; ++count) {
    const Placement stream = linearStream({count, 1, 1, 1});
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
  const Placement whole = linearStream({5, 4, 3, 1});
  for (int first = 0; first < 60; ++first) {
    for (int last = first; last < 60; ++last) {
      Placement region = whole;
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
