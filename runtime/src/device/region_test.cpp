// SPDX-License-Identifier: MIT
//
// Promises: regions with strides overlap exactly where they have an element in common.
#include "device/region.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

namespace {

using sk::AffineRegion;
using sk::Index;
using sk::Shape;
using sk::StreamRegion;

std::vector<std::int64_t> numbersOf(const StreamRegion& region) {
  const AffineRegion all = sk::affine(region);
  std::vector<std::int64_t> numbers;
  for (std::int64_t w = 0; w < all.extent[3]; ++w) {
    for (std::int64_t z = 0; z < all.extent[2]; ++z) {
      for (std::int64_t y = 0; y < all.extent[1]; ++y) {
        for (std::int64_t x = 0; x < all.extent[0]; ++x) {
          numbers.push_back(all.first + x * all.stride[0] + y * all.stride[1] + z * all.stride[2] +
                            w * all.stride[3]);
        }
      }
    }
  }
  std::ranges::sort(numbers);
  return numbers;
}

TEST_CASE("an affine region has the fastest dimension first") {
  const AffineRegion all = sk::affine({nullptr, {}, Shape(2, 3), Index(10, 2), 5});
  CHECK(all.first == 5);
  CHECK(all.stride[0] == 2);
  CHECK(all.stride[1] == 10);
  CHECK(all.extent == std::array<std::int64_t, 4>{3, 2, 1, 1});
  CHECK(all.last() == 5 + 2 * 2 + 10);
}

TEST_CASE("strided regions overlap where they share an element") {
  std::mt19937 random(3);
  const auto upTo = [&](std::int64_t most) {
    return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most + 1));
  };
  int overlapping = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::int64_t width = 4 + upTo(9), height = 3 + upTo(5);  // of the stream of both
    const auto part = [&] {
      const std::int64_t x = upTo(2), y = upTo(2), byX = 1 + upTo(3), byY = 1 + upTo(2);
      return StreamRegion{nullptr,
                          {},
                          Shape((height - y - 1) / byY + 1, (width - x - 1) / byX + 1),
                          Index(byY * width, byX),
                          y * width + x};
    };
    const StreamRegion a = part();
    // every third round, any numbers of the stream
    const StreamRegion b =
        round % 3 != 0 ? part() : StreamRegion{nullptr, {}, Shape(upTo(5) + 1), Index(1 + upTo(6)), upTo(9)};
    std::vector<std::int64_t> common;
    std::ranges::set_intersection(numbersOf(a), numbersOf(b), std::back_inserter(common));
    INFO(round);
    CHECK(sk::overlap(a, b) == !common.empty());
    CHECK(sk::overlap(b, a) == !common.empty());
    overlapping += common.empty() ? 0 : 1;
  }
  CHECK(overlapping > 200);
  CHECK(overlapping < 1800);
}

TEST_CASE("empty regions overlap with nothing") {
  CHECK_FALSE(sk::overlap({nullptr, {}, Shape(0), Index(1), 0}, {nullptr, {}, Shape(5), Index(1), 0}));
}

}  // namespace
