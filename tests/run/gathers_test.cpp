// SPDX-License-Identifier: MIT
//
// Gathers against plain C++: every boundary mode at indices inside, outside and at the limits of int, for ranks 1 and 2,
// every layout and every kind of index. All results are exact.
#include <limits>

#include "gathers.sk.hpp"
#include "support/boundary_modes.hpp"
#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

template <class T>
T at(const HostArray<T>& a, std::int64_t x, Inside inside) {
  const std::int64_t p = inside(x, a.shape()[0]);
  return p < 0 ? static_cast<T>(outsideValue) : a[{p}];
}
template <class T>
T at(const HostArray<T>& a, std::int64_t x, std::int64_t y, Inside inside) {
  const std::int64_t p = inside(x, a.shape()[1]), q = inside(y, a.shape()[0]);
  return p < 0 || q < 0 ? static_cast<T>(outsideValue) : a[{q, p}];
}

template <class T>
HostArray<T> numbered(const sk::Shape& shape) {
  return HostArray<T>(shape, [](std::size_t i) { return static_cast<T>(3 * i + 1); });
}

const std::vector<int> indices = {0,           1,
                                  2,           3,
                                  5,           11,
                                  12,          13,
                                  14,          63,
                                  64,          65,
                                  66,          100,
                                  1000,        65536,
                                  1 << 24,     (1 << 24) + 1,
                                  1 << 30,     (1 << 30) + 1,
                                  2147483646,  2147483647,
                                  -1,          -2,
                                  -3,          -4,
                                  -5,          -12,
                                  -13,         -14,
                                  -64,         -65,
                                  -1000,       -(1 << 24),
                                  -(1 << 30),  -(1 << 30) - 1,
                                  -2147483647, -2147483647 - 1};

template <class Row, class Plane>
void checkMode(sk::Device& device, const char* mode, Inside inside, const Row& row, const Plane& plane) {
  const auto count = static_cast<std::int64_t>(indices.size());
  const auto i = streamOf<int>(device, indices);
  auto r = device.stream<int>({count}), n = device.stream<int>({count});
  for (const std::int64_t extent : {1, 2, 13, 64, 67}) {
    INFO(mode << ", extent " << extent);
    const auto a = numbered<int>({extent});
    row(a.on(device), i, r, n);
    CHECK(difference(r.read(), [&](std::size_t k) { return at(a, indices[k], inside); }) == "");
    CHECK(difference(n.read(), [&](std::size_t k) {
            return at(a, std::int64_t{indices[k]} + std::int64_t(k), inside);
          }) == "");
  }
  std::vector<sk::int2> pairs;
  for (const int y : indices) {
    for (const int x : indices) pairs.push_back({x, y});
  }
  const sk::Shape square{count, count};
  const auto ij = streamOf<sk::int2>(device, square, pairs);
  std::vector<sk::Stream<int>> out;
  for (int k = 0; k < 4; ++k) out.push_back(device.stream<int>(square));
  for (const sk::Shape& shape :
       {sk::Shape{1, 1}, sk::Shape{13, 5}, sk::Shape{3, 67}, sk::Shape{65, 2}, sk::Shape{1, 12}}) {
    INFO(mode << ", shape " << sk::toString(shape));
    const auto a = numbered<int>(shape);
    plane(a.on(device), ij, out[0], out[1], out[2], out[3]);
    const auto read = [&](std::size_t k) { return at(a, pairs[k].x, pairs[k].y, inside); };
    const auto near = [&](std::size_t k) {
      const auto p = positionOf(square, k);
      return at(a, pairs[k].x + p[1], pairs[k].y + p[0], inside);
    };
    CHECK(difference(out[0].read(), read) == "");
    CHECK(difference(out[1].read(), read) == "");
    CHECK(difference(out[2].read(), near) == "");
    CHECK(difference(out[3].read(), near) == "");
  }
}

}  // namespace

TEST_CASE("an index may be any int, and the boundary mode says what it gives outside") {
  onEveryLayout([](sk::Device& device) {
    checkMode(device, "wrap", wrapIndex, gathers::row_wrap, gathers::plane_wrap);
    if (!takesAllCases(device)) return;  // modes are text about indices, not about layouts
    checkMode(device, "clamp", clampIndex, gathers::row_clamp, gathers::plane_clamp);
    checkMode(device, "mirror", mirrorIndex, gathers::row_mirror, gathers::plane_mirror);
    checkMode(device, "border", borderIndex, gathers::row_border, gathers::plane_border);
  });
}

namespace {

template <class Kernel>
void checkFloatIndices(sk::Device& device, const char* mode, Inside inside, const Kernel& kernel) {
  INFO(mode);
  const std::vector<float> floats = {0,
                                     0.25f,
                                     0.49f,
                                     0.75f,
                                     1,
                                     1.5f,
                                     2.5f,
                                     -0.25f,
                                     -0.5f,
                                     -0.75f,
                                     -3,
                                     6.4f,
                                     6.6f,
                                     7.5f,
                                     100.2f,
                                     16777216.0f,
                                     2147483520.0f,
                                     -2147483648.0f,
                                     3e9f,
                                     -3e9f,
                                     1e30f,
                                     -1e30f,
                                     std::numeric_limits<float>::infinity(),
                                     -std::numeric_limits<float>::infinity()};
  const auto nearest = [](float x) {
    const double n = std::floor(double{x} + 0.5);
    return static_cast<std::int64_t>(std::clamp(n, -2147483648.0, 2147483520.0));
  };
  const auto a = numbered<int>({7});
  const auto b = numbered<int>({5, 7});
  std::vector<sk::float2> x;
  for (const float v : floats) {
    for (const float w : floats) x.push_back({v, w});
  }
  const auto count = static_cast<std::int64_t>(x.size());
  auto r = device.stream<int>({count}), s = device.stream<int>({count}), t = device.stream<int>({count});
  kernel(a.on(device), b.on(device), streamOf<sk::float2>(device, x), r, s, t);
  CHECK(difference(r.read(), [&](std::size_t i) { return at(a, nearest(x[i].x), inside); }) == "");
  CHECK(difference(s.read(),
                   [&](std::size_t i) { return at(b, nearest(x[i].x), nearest(x[i].y), inside); }) == "");
  const auto mixed = t.read();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool isInt = std::fabs(x[i].x) < 1e9f && std::fabs(x[i].y) < 1e9f;  // int(x) is undefined beyond
    if (!isInt) continue;
    const int expected = at(b, nearest(x[i].x), nearest(x[i].y), inside) +
                         at(b, static_cast<int>(std::fabs(x[i].x)), static_cast<int>(x[i].y), inside);
    CHECK(mixed[i] == expected);
  }

  // NaN as an index gives any element, or the border.
  const float nan = std::numeric_limits<float>::quiet_NaN();
  auto one = device.stream<int>({1}), two = device.stream<int>({1}), three = device.stream<int>({1});
  kernel(a.on(device), b.on(device), streamOf<sk::float2>(device, {{nan, nan}}), one, two, three);
  const auto isElement = [](const HostArray<int>& array, int v) {
    return v == outsideValue || std::count(array.elements().begin(), array.elements().end(), v) == 1;
  };
  CHECK(isElement(a, one.read()[0]));
  CHECK(isElement(b, two.read()[0]));
}

}  // namespace

TEST_CASE("a float index names the nearest element") {
  onSomeLayouts([](sk::Device& device) {
    checkFloatIndices(device, "wrap", wrapIndex, gathers::float_wrap);
    if (!takesAllCases(device)) return;  // modes are text about indices, not about layouts
    checkFloatIndices(device, "clamp", clampIndex, gathers::float_clamp);
    checkFloatIndices(device, "mirror", mirrorIndex, gathers::float_mirror);
    checkFloatIndices(device, "border", borderIndex, gathers::float_border);
  });
}

namespace {

template <class Plane, class Line>
void checkStencils(sk::Device& device, const char* mode, Inside inside, const Plane& plane,
                   const Line& line) {
  struct Row {
    sk::Shape gather, domain;
  };
  for (const Row& row :
       {Row{{11, 17}, {11, 17}}, Row{{1, 1}, {1, 1}}, Row{{1, 9}, {1, 9}}, Row{{67, 2}, {67, 2}},
        Row{{2, 67}, {2, 67}}, Row{{5, 6}, {9, 14}}, Row{{9, 70}, {3, 4}}}) {
    INFO(mode << ", gather " << sk::toString(row.gather) << ", domain " << sk::toString(row.domain));
    const auto a = numbered<int>(row.gather);
    auto r = device.stream<int>(row.domain), far = device.stream<int>(row.domain);
    plane(a.on(device), r, far);
    const auto near = [&](std::size_t i, std::int64_t dx, std::int64_t dy) {
      const auto p = positionOf(row.domain, i);
      return at(a, p[1] + dx, p[0] + dy, inside);
    };
    CHECK(difference(r.read(), [&](std::size_t i) {
            return near(i, 0, 0) + 3 * near(i, 1, 0) + 5 * near(i, -1, 0) + 7 * near(i, 0, 1) +
                   11 * near(i, 0, -1) + 13 * near(i, -1, -1) + 17 * near(i, 1, 1);
          }) == "");
    CHECK(difference(far.read(), [&](std::size_t i) {
            return near(i, 9, -4) + 2 * near(i, -100, 0) + 3 * near(i, 3, 1000000);
          }) == "");
  }
  for (const std::int64_t extent : {1, 2, 3, 64, 131}) {
    INFO(mode << ", extent " << extent);
    const auto a = numbered<float>({extent});
    auto r = device.stream<float>({extent});
    line(a.on(device), r);
    CHECK(difference(r.read(), [&](std::size_t i) {
            const auto near = [&](int d) { return at(a, static_cast<std::int64_t>(i) + d, inside); };
            return near(-1) + 2 * near(0) + 4 * near(1) + 8 * near(2);
          }) == "");
  }
}

}  // namespace

TEST_CASE("neighbours may lie beyond the end, further than the extent even") {
  onSomeLayouts([](sk::Device& device) {
    checkStencils(device, "wrap", wrapIndex, gathers::stencil_wrap, gathers::line_wrap);
    if (!takesAllCases(device)) return;  // modes are text about indices, not about layouts
    checkStencils(device, "clamp", clampIndex, gathers::stencil_clamp, gathers::line_clamp);
    checkStencils(device, "mirror", mirrorIndex, gathers::stencil_mirror, gathers::line_mirror);
    checkStencils(device, "border", borderIndex, gathers::stencil_border, gathers::line_border);
  });
}

TEST_CASE("a gather may be a view, whose edges are then the boundary") {
  onEveryLayout([](sk::Device& device) {
    const auto whole = numbered<int>({12, 90});
    auto stream = whole.on(device);
    const auto part = stream.domain({3, 20}, {8, 85});
    const HostArray<int> a(
        part.shape(), [&](std::size_t i) { return whole[inside({3, 20}, positionOf(part.shape(), i))]; });
    auto r = device.stream<int>(part.shape()), far = device.stream<int>(part.shape());
    gathers::stencil_wrap(part, r, far);
    CHECK(difference(r.read(), [&](std::size_t i) {
            const auto p = positionOf(part.shape(), i);
            const auto near = [&](int dx, int dy) { return at(a, p[1] + dx, p[0] + dy, wrapIndex); };
            return near(0, 0) + 3 * near(1, 0) + 5 * near(-1, 0) + 7 * near(0, 1) + 11 * near(0, -1) +
                   13 * near(-1, -1) + 17 * near(1, 1);
          }) == "");
    // Writes to a view of the stream that it reads, at another place.
    gathers::stencil_border(part, stream.domain({7, 0}, {12, 65}), far);
    CHECK(difference(stream.domain({7, 0}, {12, 65}).read(), [&](std::size_t i) {
            const auto p = positionOf(part.shape(), i);
            const auto near = [&](int dx, int dy) { return at(a, p[1] + dx, p[0] + dy, borderIndex); };
            return near(0, 0) + 3 * near(1, 0) + 5 * near(-1, 0) + 7 * near(0, 1) + 11 * near(0, -1) +
                   13 * near(-1, -1) + 17 * near(1, 1);
          }) == "");
    CHECK(stream.domain({0, 0}, {7, 90}).read() ==
          std::vector<int>(whole.elements().begin(), whole.elements().begin() + 630));
  });
}
