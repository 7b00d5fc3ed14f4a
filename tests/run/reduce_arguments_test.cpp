// SPDX-License-Identifier: MIT
//
// Folds of several inputs, with uniforms, gathers, iterators and specialisation constants, against plain loops: inputs of
// different layouts, views, and broadcast inputs.
#include <cmath>

#include "reduce_arguments.sk.hpp"
#include "support/devices.hpp"
#include "support/folds.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float2, sk::int2, sk::uint2;

namespace {

/// Integers in [-8, 8), so that sums of products are exact.
float otherAt(std::size_t i) { return smallAt(i + 100003); }
std::uint32_t bitsAt(std::size_t i) { return valueAt<std::uint32_t>(static_cast<std::uint32_t>(i)); }

const std::vector<sk::Shape> allShapes = {{1},      {31},     {1021},     {4093},
                                          {13, 17}, {1, 200}, {5, 7, 11}, {2, 3, 5, 7}};

/// Every shape, or a line and a plane of several passes each: the other ranks read elements by the same functions.
std::vector<sk::Shape> shapesOn(const sk::Device& device) {
  return takesAllCases(device) ? allShapes : std::vector<sk::Shape>{{4093}, {13, 17}};
}

std::size_t count(const sk::Shape& shape) { return static_cast<std::size_t>(shape.size()); }

}  // namespace

TEST_CASE("two inputs, wherever they lie") {
  onEveryLayout([](sk::Device& device) {
    for (const sk::Shape& shape : allShapes) {
      INFO(sk::toString(shape));
      const HostArray<float> x(shape, smallAt), y(shape, otherAt);
      float expected = 0;
      for (std::size_t i = 0; i < count(shape); ++i) expected += x.elements()[i] * y.elements()[i];
      CHECK(folds::dot(x.on(device), y.on(device)) == expected);
      // A view and a whole stream.
      sk::Shape larger = shape;
      sk::Index begin = sk::Index::origin(shape.rank()), end = begin;
      for (int d = 0; d < shape.rank(); ++d) {
        larger = larger.with(d, shape[d] + 2);
        begin[d] = 1;
        end[d] = shape[d] + 1;
      }
      auto room = device.stream<float>(larger);
      room.domain(begin, end).write(y.elements());
      CHECK(folds::dot(x.on(device), room.domain(begin, end)) == expected);
      CHECK(folds::dot(room.domain(begin, end), x.on(device)) == expected);
    }
  });
}

TEST_CASE("inputs of extent 1 repeat, also each in another dimension") {
  onSomeLayouts([](sk::Device& device) {
    for (const auto& [a, b, whole] :
         {std::tuple{sk::Shape{37, 41}, sk::Shape{1, 41}, sk::Shape{37, 41}},
          std::tuple{sk::Shape{37, 1}, sk::Shape{1, 41}, sk::Shape{37, 41}},
          std::tuple{sk::Shape{1}, sk::Shape{1021}, sk::Shape{1021}},
          std::tuple{sk::Shape{4, 1, 6}, sk::Shape{4, 5, 1}, sk::Shape{4, 5, 6}}}) {
      INFO(sk::toString(a) << " with " << sk::toString(b));
      const HostArray<float> x(a, smallAt), y(b, otherAt);
      float expected = 0;
      for (std::size_t i = 0; i < count(whole); ++i) {
        const Position p = positionOf(whole, i);
        expected += x.repeated(p) * y.repeated(p);
      }
      CHECK(folds::dot(x.on(device), y.on(device)) == expected);
      sk::Shape blocks = whole;
      for (int d = 1; d < blocks.rank(); ++d) blocks = blocks.with(d, 1);
      auto rows = device.stream<float>(blocks);
      folds::dot(x.on(device), y.on(device), rows);
      float sum = 0;
      for (const float row : rows.read()) sum += row;
      CHECK(sum == expected);
    }
    CHECK_THROWS_WITH(
        folds::dot(device.stream<float>({3, 4}), device.stream<float>({3, 5})),
        "folds::dot: 'y' has shape {3, 5}, but the inputs together have {3, 4}; give them the same "
        "shape, or extent 1 where one repeats");
  });
}

TEST_CASE("inputs of different types") {
  onSomeLayouts([](sk::Device& device) {
    const sk::Shape shape{1021};
    const HostArray<std::uint32_t> a(shape, [](std::size_t i) { return bitsAt(i) % 4; });
    const HostArray<uint2> b(shape,
                             [](std::size_t i) { return uint2{bitsAt(i + 9) % 4, bitsAt(2 * i) % 4}; });
    const HostArray<std::uint8_t> c(shape, [](std::size_t i) { return std::uint8_t(i % 3 == 0); });
    int expected = 0;
    for (std::size_t i = 0; i < 1021; ++i) {
      const std::uint32_t v = a.elements()[i];
      expected += v == b.elements()[i].x || (c.elements()[i] != 0 && v == b.elements()[i].y);
    }
    CHECK(folds::equalBits(a.on(device), b.on(device), streamOf<bool>(device, shape, c.elements())) ==
          expected);
  });
}

TEST_CASE("uniforms, arrays and structs of them among them") {
  onEveryTarget([](sk::Device& device) {
    const HostArray<float> x({4093}, smallAt);
    const auto stream = x.on(device);
    float sum = 0, weighed = 0;
    int inside = 0;
    const folds::Weights weights{2, {1, 3, 5}};
    for (const float v : x.elements()) {
      sum += 3 * v;
      weighed += (2 + 1 + 3 * v + 4 * 5) * 2;
      inside += v >= -2 && v <= 5;
    }
    CHECK(folds::scaled(3, stream) == sum);
    CHECK(folds::scaled(-3, stream) == -sum);
    CHECK(folds::weighed(weights, std::array{2, 4}, stream) == weighed);
    CHECK(folds::inside(-2, 5, stream) == inside);
    CHECK(folds::inside(-2, 5, device.stream<float>({0})) == 0);
  });
}

TEST_CASE("what combines has the uniforms, too") {
  onSomeLayouts([](sk::Device& device) {
    const HostArray<float2> places({4093}, [](std::size_t i) { return float2{smallAt(i), otherAt(7 * i)}; });
    auto points = device.stream<folds::Point>(4093);
    folds::points(places.on(device), points);
    for (const float2 p : {float2{0, 0}, float2{-7.75f, 3.25f}, float2{100, 2}}) {
      float least = INFINITY;
      for (const float2& q : places.elements()) {
        least = std::min(least, (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
      }
      const folds::Point best = folds::nearestTo(p, points);
      CHECK((best.at.x - p.x) * (best.at.x - p.x) + (best.at.y - p.y) * (best.at.y - p.y) == least);
    }
    for (const sk::Shape& shape : shapesOn(device)) {
      INFO(sk::toString(shape));
      const HostArray<std::uint32_t> x(shape, bitsAt), y(shape, [](std::size_t i) { return bitsAt(i + 77); });
      std::uint32_t a = 1, b = 0, c = 0;
      for (std::size_t i = 0; i < count(shape); ++i) {
        a *= 31;
        b = b * 31 + x.elements()[i];
        c = c * 31 + (x.elements()[i] ^ y.elements()[i]);
      }
      const folds::Affine one = folds::horner(x.on(device), 31u);
      CHECK((one.a == a && one.b == b));
      const folds::Affine two = folds::shifted(31u, x.on(device), y.on(device));
      CHECK((two.a == a && two.b == c));
    }
  });
}

TEST_CASE("gathers of rank 1 and 2, with their boundaries") {
  onSomeLayouts([](sk::Device& device) {
    const HostArray<float> table({97}, otherAt), square({11, 9}, smallAt);
    const auto tableStream = table.on(device);
    const auto squareStream = square.on(device);
    for (const sk::Shape& shape : shapesOn(device)) {
      INFO(sk::toString(shape));
      const HostArray<int> i(shape, [](std::size_t k) { return static_cast<int>(bitsAt(k) % 300) - 100; });
      const HostArray<int2> p(shape, [](std::size_t k) {
        return int2{static_cast<int>(k % 13) - 2, static_cast<int>(k % 7) + 3};
      });
      float wrapped = 0, bordered = 0;
      for (std::size_t k = 0; k < count(shape); ++k) {
        wrapped += table.elements()[static_cast<std::size_t>((i.elements()[k] % 97 + 97) % 97)];
        const int2 at = p.elements()[k];
        const bool isInside = at.x >= 0 && at.x < 9 && at.y >= 0 && at.y < 11;
        bordered += isInside ? square.elements()[static_cast<std::size_t>(at.y * 9 + at.x)] : -3;
      }
      CHECK(folds::looked(i.on(device), tableStream) == wrapped);
      CHECK(folds::looked2(p.on(device), squareStream) == bordered);
      auto one = device.scalar<float>();
      auto several = device.stream<float>({3});
      folds::looked(i.on(device), tableStream, one);
      CHECK(one.read() == wrapped);
      several.fill(7);
      folds::looked2(p.on(device), squareStream, several.domain({1}, {2}));
      CHECK(several.read() == std::vector<float>{7, bordered, 7});
      int best = i.elements()[0];
      const auto cost = [&](int at) {
        return table.elements()[static_cast<std::size_t>(std::clamp(at, 0, 96))];
      };
      for (const int at : i.elements()) best = cost(at) < cost(best) ? at : best;
      CHECK(cost(folds::cheapest(i.on(device), tableStream)) == cost(best));
    }
    const int2 extents = folds::extents(device.stream<float>({700}), squareStream);
    CHECK((extents.x == 9 && extents.y == 11));
  });
}

TEST_CASE("neighbours are those of the element that is folded") {
  onSomeLayouts([](sk::Device& device) {
    const sk::Shape shape{37, 90};
    const HostArray<float> x(shape, smallAt), a(shape, otherAt);
    const auto at = [&](std::int64_t row, std::int64_t column) {
      const auto mirrored = [](std::int64_t i, std::int64_t n) {
        return i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i;
      };
      return a[{mirrored(row, 37), mirrored(column, 90)}];
    };
    std::vector<float> rows(37, 0.0f);
    float expected = 0;
    for (std::int64_t row = 0; row < 37; ++row) {
      for (std::int64_t column = 0; column < 90; ++column) {
        const float one = std::fabs(at(row, column + 1) - at(row + 1, column)) + x[{row, column}];
        expected += one;
        rows[static_cast<std::size_t>(row)] += one;
      }
    }
    CHECK(folds::rough(x.on(device), a.on(device)) == expected);
    auto all = device.stream<float>({1, 1});
    folds::rough(x.on(device), a.on(device), all);
    CHECK(all.read() == std::vector<float>{expected});
    auto sums = device.stream<float>({37, 1});
    folds::rough(x.on(device), a.on(device), sums);
    CHECK(difference(sums.read(), rows) == "");
  });
}

TEST_CASE("a gather or an input may be the stream that is folded into") {
  onSomeLayouts([](sk::Device& device) {
    const HostArray<float> x({6, 20}, smallAt);
    auto stream = x.on(device);
    auto sums = device.stream<float>({6, 1});
    folds::rough(stream, stream, sums);
    folds::rough(stream, stream, stream.domain({0, 3}, {6, 4}));
    CHECK(difference(stream.domain({0, 3}, {6, 4}).read(), sums.read()) == "");
    auto line = device.stream<float>({6, 20});
    line.write(x.elements());
    folds::dot(line, line, line);
    CHECK(difference(line.read(), [&](std::size_t i) { return x.elements()[i] * x.elements()[i]; }) == "");
  });
}

TEST_CASE("iterators count the elements that are folded") {
  onSomeLayouts([](sk::Device& device) {
    for (const sk::Shape& shape : shapesOn(device)) {
      INFO(sk::toString(shape));
      const HostArray<std::uint32_t> x(shape, bitsAt);
      std::uint32_t expected = 0;
      for (std::size_t i = 0; i < count(shape); ++i) {
        expected += x.elements()[i] * static_cast<std::uint32_t>(5 + 2 * static_cast<int>(i));
      }
      const int n = static_cast<int>(count(shape));
      CHECK(folds::ramp(sk::iter(5, 5 + 2 * n), x.on(device)) == expected);
    }
    const HostArray<float> x({16, 32}, smallAt);
    float expected = 0;
    for (std::size_t i = 0; i < 512; ++i) {
      expected += static_cast<float>(i % 32) * x.elements()[i] + static_cast<float>(i / 32);
    }
    CHECK(folds::grid(sk::iter(float2{0, 0}, float2{32, 16}), x.on(device)) == expected);
    CHECK_THROWS_AS(folds::ramp(sk::iter(0, 7), device.stream<unsigned>({4})), sk::Error);
  });
}

TEST_CASE("specialisation constants leave streams out") {
  onSomeLayouts([](sk::Device& device) {
    const HostArray<float> x({1021}, smallAt), y({1021}, otherAt);
    float squares = 0, sum = 0, least = INFINITY;
    for (std::size_t i = 0; i < 1021; ++i) {
      squares += x.elements()[i] * x.elements()[i];
      sum += y.elements()[i];
      least = std::min(least, x.elements()[i]);
    }
    CHECK(folds::either(true, 1, x.on(device), sk::none) == squares);
    CHECK(folds::either(false, 2, sk::none, y.on(device)) == 2 * sum);
    CHECK(folds::either(false, 0, x.on(device), y.on(device)) == 0);
    CHECK(folds::least(false, sk::none, x.on(device)) == least);
    CHECK(folds::least(true, streamOf<float>(device, {2.0f}), x.on(device)) == 2 * least);
    CHECK_THROWS_WITH(folds::either(true, 1, sk::none, y.on(device)),
                      Catch::Contains("'x' is sk::none") && Catch::Contains("squares"));
  });
}
