// SPDX-License-Identifier: MIT
//
// Checks runs against the definition of a linearised layout: element n is texel (n & (w - 1), n >> shift).
#include "gl_device/transfer/copy_regions.hpp"

#include <array>
#include <vector>

#include <catch2/catch.hpp>

#include "gl_device/memory/layout.hpp"

using sk::CopyRegion;
using sk::forEachCopyRegion;
using sk::Index;
using sk::Shape;
using sk::assemble::Rect;
using sk::assemble::RegionLayout;

namespace {

/// The numbers of a region's elements in its stream, row-major.
std::vector<std::int64_t> numbersOf(const RegionLayout& p) {
  std::vector<std::int64_t> numbers;
  for (std::int64_t w = 0; w < p.extent[3]; ++w)
    for (std::int64_t z = 0; z < p.extent[2]; ++z)
      for (std::int64_t y = 0; y < p.extent[1]; ++y)
        for (std::int64_t x = 0; x < p.extent[0]; ++x)
          numbers.push_back((p.origin[0] + x) * p.stride[0] + (p.origin[1] + y) * p.stride[1] +
                            (p.origin[2] + z) * p.stride[2] + (p.origin[3] + w) * p.stride[3]);
  return numbers;
}

/// The same numbers, computed from the texels of the runs.
std::vector<std::int64_t> numbersOfRuns(const RegionLayout& p, int& rects) {
  std::vector<std::int64_t> numbers;
  forEachCopyRegion(p, [&](const CopyRegion& run) {
    ++rects;
    CHECK(run.first == static_cast<std::int64_t>(numbers.size()));
    for (int y = 0; y < run.rect.height; ++y)
      for (int x = 0; x < run.rect.width; ++x)
        numbers.push_back((std::int64_t{run.rect.y} + y) << p.shift | (run.rect.x + x));
  });
  return numbers;
}

}  // namespace

TEST_CASE("runs are the elements of a region, in order") {
  struct Case {
    Shape shape;
    Index begin;
    Shape part;
    int rects;
  };
  const std::vector<Case> cases{
      {{1000}, {0}, {1000}, 2},                      // the texture is 32 wide: 31 rows and a part
      {{1000}, {5}, {3}, 1},                         // inside a row
      {{1000}, {30}, {4}, 2},                        // across the end of a row
      {{1000}, {30}, {900}, 3},                      // a part, rows, a part
      {{1000}, {32}, {64}, 1},                       // rows
      {{4, 5, 6}, {0, 0, 0}, {4, 5, 6}, 2},          // the whole stream is one run
      {{4, 5, 6}, {1, 0, 0}, {2, 5, 6}, 3},          // two slices are one run
      {{4, 5, 6}, {1, 1, 0}, {2, 2, 6}, -1},
      {{4, 5, 6}, {1, 1, 1}, {2, 2, 2}, -1},
      {{3, 4, 5, 6}, {1, 1, 1, 1}, {1, 2, 2, 4}, -1},
      {{3, 4, 5, 6}, {0, 1, 0, 0}, {3, 1, 5, 6}, -1},
      {{200, 3}, {7, 1}, {100, 1}, 100},
      {{100, 100}, {0, 0}, {100, 100}, 2},           // layered: rows continue across layers
      {{100, 100}, {3, 5}, {90, 80}, -1},
  };
  for (const Case& c : cases) {
    const sk::Layout layout = sk::layoutOf(c.shape, {64, 256});
    REQUIRE(layout.whole.linear);
    const RegionLayout regionLayout = regionLayoutOf({nullptr, c.begin, c.part}, layout);
    INFO(toString(c.shape) << " from " << toString(c.begin) << " " << toString(c.part));
    int rects = 0;
    CHECK(numbersOfRuns(regionLayout, rects) == numbersOf(regionLayout));
    if (c.rects >= 0) {
      CHECK(rects == c.rects);
    }
    const Rect rows = sk::rowsOf(regionLayout);
    const auto numbers = numbersOf(regionLayout);
    CHECK(rows.y == numbers.front() >> regionLayout.shift);
    CHECK(rows.y + rows.height - 1 == numbers.back() >> regionLayout.shift);
  }
}

TEST_CASE("rectangles are cut where layers end") {
  std::vector<std::array<int, 4>> parts;
  const auto visit = [&](const Rect& part, std::int32_t layer, std::int32_t first) {
    CHECK((part.x == 3 && part.width == 4));
    parts.push_back({layer, part.y, part.height, first});
  };
  sk::forEachLayer({3, 10, 4, 30}, 16, visit);
  CHECK(parts == std::vector<std::array<int, 4>>{{0, 10, 6, 0}, {1, 0, 16, 6}, {2, 0, 8, 22}});
  parts.clear();
  sk::forEachLayer({3, 10, 4, 30}, 0, visit);
  CHECK(parts == std::vector<std::array<int, 4>>{{0, 10, 30, 0}});
}

TEST_CASE("a region of a plane is one rectangle") {
  const sk::Layout layout = sk::layoutOf({10, 20}, {64, 256});
  int count = 0;
  forEachCopyRegion(regionLayoutOf({nullptr, Index(2, 3), Shape(4, 5)}, layout), [&](const CopyRegion& run) {
    ++count;
    CHECK(run.rect == Rect{3, 2, 5, 4});
    CHECK(run.first == 0);
  });
  CHECK(count == 1);
}
