// SPDX-License-Identifier: MIT
//
// Reductions: of any length, in order, to a value and to a smaller stream, of structs, of no elements.
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "elements.hpp"
#include "error_of.hpp"
#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

const TestReduction& sum() {
  static const TestReduction reduction("sum", "void sum(int x, inout int total) { total += x; }\n",
                                       {input<std::int32_t>("x"), accumulator<std::int32_t>("total", "0")},
                                       true);
  return reduction;
}

/// Joins runs of consecutive integers, which is not commutative. A run is (first, last, isInOrder); isInOrder becomes 0 as
/// soon as two joined runs do not follow each other.
const TestReduction& inOrder() {
  static const TestReduction reduction("inOrder",
                                       "void inOrder(ivec3 x, inout ivec3 r) { r = ivec3(r.x, x.y, (r.z != 0 "
                                       "&& x.z != 0 && r.y + 1 == x.x) ? 1 : 0); }\n",
                                       {input<int3>("x"), accumulator<int3>("r")}, true);
  return reduction;
}

std::vector<int3> runs(std::int64_t count) {
  std::vector<int3> elements(static_cast<std::size_t>(count));
  for (std::int32_t i = 0; i < count; ++i) {
    elements[static_cast<std::size_t>(i)] = {i, i, 1};
  }
  return elements;
}

}  // namespace

TEST_CASE("a sum of any length") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device({.profile = profile, .textureLimit = limit});
  for (const std::int64_t count : {0, 1, 2, 31, 32, 33, 1021, 1024, 4095}) {
    auto x = device.stream<std::int32_t>(count);
    std::vector<std::int32_t> host(static_cast<std::size_t>(count));
    std::iota(host.begin(), host.end(), 1);
    x.write(host);
    INFO("count " << count);
    CHECK(sum().value<std::int32_t>(x) == count * (count + 1) / 2);
  }
}

TEST_CASE("order is kept, in every shape") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device({.profile = profile, .textureLimit = limit});
  for (const Shape& shape : {Shape(1), Shape(97), Shape(4096), Shape(37, 53), Shape(64, 64), Shape(1, 200),
                             Shape(200, 1), Shape(7, 11, 13), Shape(2, 3, 5, 7)}) {
    auto x = device.stream<int3>(shape);
    x.write(runs(shape.size()));
    INFO("shape " << toString(shape));
    CHECK(inOrder().value<int3>(x) == int3{0, static_cast<std::int32_t>(shape.size()) - 1, 1});
  }
}

TEST_CASE("a large sum") {
  const auto profile = GENERATE(from_range(profileNames));
  Device device({.profile = profile});
  constexpr std::int64_t count = (1 << 20) + 7;
  auto x = device.stream<std::int32_t>(count);
  x.write(std::vector<std::int32_t>(count, 3));
  CHECK(sum().value<std::int32_t>(x) == 3 * count);
}

TEST_CASE("a view is reduced by itself") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device({.profile = profile, .textureLimit = limit});
  auto x = device.stream<std::int32_t>({12, 100});
  std::vector<std::int32_t> host(1200);
  std::iota(host.begin(), host.end(), 0);
  x.write(host);
  const auto view = x.domain({3, 5}, {10, 93});
  const auto part = view.read();
  CHECK(sum().value<std::int32_t>(view) == std::accumulate(part.begin(), part.end(), 0));
  CHECK(sum().value<std::int32_t>(x.domain({3, 5}, {3, 93})) == 0);
}

TEST_CASE("blocks are folded to a smaller stream, in order") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device({.profile = profile, .textureLimit = limit});
  const auto [shape, smaller] = GENERATE(table<Shape, Shape>({{{12, 20}, {12, 1}},
                                                              {{12, 20}, {1, 20}},
                                                              {{12, 20}, {3, 4}},
                                                              {{12, 20}, {12, 20}},
                                                              {{40, 90}, {10, 9}},
                                                              {{4000}, {4}},
                                                              {{4000}, {1000}},
                                                              {{8, 9, 10}, {2, 3, 5}},
                                                              {{2, 6, 4, 9}, {1, 2, 4, 3}}}));
  INFO(toString(shape) << " to " << toString(smaller));
  // Each block's elements are numbered in row-major order within the block.
  std::vector<int3> host(static_cast<std::size_t>(shape.size()));
  std::int64_t length = 1;
  for (int d = 0; d < shape.rank(); ++d) {
    length *= shape[d] / smaller[d];
  }
  for (std::int64_t i = 0; i < shape.size(); ++i) {
    std::int64_t rest = i;
    std::int64_t number = 0;
    std::int64_t step = 1;
    for (int d = shape.rank() - 1; d >= 0; --d) {
      const std::int64_t block = shape[d] / smaller[d];
      number += rest % shape[d] % block * step;
      step *= block;
      rest /= shape[d];
    }
    host[static_cast<std::size_t>(i)] = {static_cast<std::int32_t>(number), static_cast<std::int32_t>(number),
                                         1};
  }
  auto x = device.stream<int3>(shape);
  auto r = device.stream<int3>(smaller);
  x.write(host);
  inOrder()(x, r);
  CHECK(r.read() == std::vector<int3>(static_cast<std::size_t>(smaller.size()),
                                      int3{0, static_cast<std::int32_t>(length) - 1, 1}));
}

TEST_CASE("a result that is a view, and one in the stream that is folded") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 16);
  Device device({.profile = profile, .textureLimit = limit});
  auto x = device.stream<std::int32_t>({8, 20});
  std::vector<std::int32_t> host(160);
  std::iota(host.begin(), host.end(), 0);
  x.write(host);
  auto r = device.stream<std::int32_t>({10, 3});
  r.write(std::vector<std::int32_t>(30, -1));
  sum()(x, r.domain({1, 1}, {9, 2}));
  for (std::int64_t row = 0; row < 8; ++row) {
    CHECK(r.domain({1 + row, 1}, {2 + row, 2}).read()[0] == 190 + 400 * row);
  }
  CHECK(r.domain({0, 0}, {1, 3}).read() == std::vector<std::int32_t>(3, -1));
  sum()(x, x.domain({0, 0}, {8, 1}));
  for (std::int64_t row = 0; row < 8; ++row) {
    CHECK(x.domain({row, 0}, {row + 1, 2}).read() ==
          std::vector<std::int32_t>{static_cast<std::int32_t>(190 + 400 * row),
                                    static_cast<std::int32_t>(20 * row + 1)});
  }
}

TEST_CASE("accumulators of another type, and of structs") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device({.profile = profile, .textureLimit = limit});
  static const TestReduction nearest(
      "nearest", "void nearest(Hit h, inout Hit best) { if (h.t < best.t) best = h; }\n",
      {input<Hit>("h"), accumulator<Hit>("best", "Hit(1e30, -1)")}, true, hitDeclaration);
  static const TestReduction count(
      "count",
      "void count(bool x, inout int n) { if (x) n += 1; }\nvoid add(int x, inout int n) { n += x; }\n",
      {input<bool>("x"), accumulator<std::int32_t>("n", "0")}, false, {}, "add");
  std::vector<Hit> hits(1009);
  std::vector<std::uint8_t> bits(1009);
  for (std::int32_t i = 0; i < 1009; ++i) {
    hits[static_cast<std::size_t>(i)] = {static_cast<float>((i * 7919 + 13) % 1009), i};
    bits[static_cast<std::size_t>(i)] = i % 3 == 0;
  }
  auto h = device.stream<Hit>(1009);
  auto b = device.stream<bool>(1009);
  h.write(hits);
  b.write(bits);
  CHECK(nearest.value<Hit>(h).t == 0.0f);
  CHECK((nearest.value<Hit>(h).id * 7919 + 13) % 1009 == 0);
  CHECK(nearest.value<Hit>(h.domain(4, 4)) == Hit{1e30f, -1});
  CHECK(count.value<std::int32_t>(b) == 337);
  CHECK(count.value<std::int32_t>(b.domain(0, 1)) == 1);
  CHECK(count.value<std::int32_t>(b.domain(0, 0)) == 0);
}

TEST_CASE("no element and no identity is an error; blocks of no element are the identity") {
  const auto profile = GENERATE(from_range(profileNames));
  Device device({.profile = profile});
  auto none = device.stream<int3>(0);
  CHECK(errorOf([&] { inOrder().value<int3>(none); }) ==
        "inOrder: 'x' has shape {0}: there is no element to fold, and 'r' declares no identity");
  auto x = device.stream<std::int32_t>({0, 4});
  auto r = device.stream<std::int32_t>({0, 2});
  sum()(x, r);
  CHECK(r.read().empty());
  auto s = device.stream<std::int32_t>({3, 2});
  s.write(std::vector<std::int32_t>(6, -1));
  sum()(x, s.domain({1, 0}, {3, 2}));
  CHECK(s.read() == std::vector<std::int32_t>{-1, -1, 0, 0, 0, 0});
}
