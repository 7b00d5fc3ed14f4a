// SPDX-License-Identifier: MIT
//
// Shapes: indexof and extentof, broadcast inputs, views as inputs and outputs, calls in place.
#include "streams.sk.hpp"
#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

const std::vector<sk::Shape> testedShapes = {{1},       {7},        {65},         {1021},
                                             {1, 1},    {13, 17},   {67, 3},      {3, 67},
                                             {2, 3, 5}, {67, 2, 3}, {2, 3, 2, 5}, {3, 1, 5, 7}};

/// The shape as kernels see it: x is the last extent, missing dimensions are 1.
sk::int4 kernelShape(const sk::Shape& shape) {
  int e[4] = {1, 1, 1, 1};
  for (int d = 0; d < shape.rank(); ++d) e[d] = static_cast<int>(shape[shape.rank() - 1 - d]);
  return {e[0], e[1], e[2], e[3]};
}

sk::int4 kernelIndex(const sk::Shape& shape, std::size_t i) {
  const sk::int4 e = kernelShape(shape);
  const int n = static_cast<int>(i);
  return {n % e.x, n / e.x % e.y, n / e.x / e.y % e.z, n / e.x / e.y / e.z};
}

}  // namespace

TEST_CASE("indexof and extentof are exact in every layout") {
  onEveryLayout([](sk::Device& device) {
    for (const sk::Shape& shape : testedShapes) {
      INFO("shape " << sk::toString(shape));
      auto own = device.stream<sk::int4>(shape), ofX = device.stream<sk::int4>(shape);
      auto extent = device.stream<sk::int4>(shape), extentOfX = device.stream<sk::int4>(shape);
      streams::where(streamOf<float>(device, shape, values<float>(shape.size())), own, ofX, extent,
                     extentOfX);
      const auto index = [&](std::size_t i) { return kernelIndex(shape, i); };
      const auto wholeShape = [&](std::size_t) { return kernelShape(shape); };
      CHECK(difference(own.read(), index) == "");
      CHECK(difference(ofX.read(), index) == "");
      CHECK(difference(extent.read(), wholeShape) == "");
      CHECK(difference(extentOfX.read(), wholeShape) == "");
    }
  });
}

TEST_CASE("an input of extent 1 repeats along that dimension") {
  struct Row {
    sk::Shape x, y, z, r;
  };
  const std::vector<Row> rows = {
      {{5}, {1}, {5}, {5}},
      {{131}, {131}, {1}, {131}},
      {{7, 1}, {1, 9}, {1, 1}, {7, 9}},
      {{7, 9}, {7, 1}, {1, 9}, {7, 9}},
      {{67, 1}, {1, 5}, {67, 5}, {67, 5}},
      {{3, 1, 1}, {1, 4, 1}, {1, 1, 70}, {3, 4, 70}},
      {{3, 4, 1}, {3, 1, 5}, {1, 4, 5}, {3, 4, 5}},
      {{2, 1, 4, 1}, {1, 3, 1, 5}, {2, 3, 4, 5}, {2, 3, 4, 5}},
      {{1, 1}, {1, 1}, {1, 1}, {1, 1}},
  };
  onEveryLayout([&](sk::Device& device) {
    for (const Row& row : rows) {
      INFO(sk::toString(row.x) << sk::toString(row.y) << sk::toString(row.z) << " to "
                               << sk::toString(row.r));
      const auto numbered = [](const sk::Shape& shape) {
        return HostArray<int>(shape, [](std::size_t i) { return static_cast<int>(i % 1000); });
      };
      const auto x = numbered(row.x), y = numbered(row.y), z = numbered(row.z);
      auto r = device.stream<int>(row.r);
      auto at = device.stream<sk::int4>(row.r);
      streams::repeat(x.on(device), y.on(device), z.on(device), r, at);
      CHECK(difference(r.read(), [&](std::size_t i) {
              const auto p = positionOf(row.r, i);
              return x.repeated(p) + 1000 * y.repeated(p) + 1000000 * z.repeated(p);
            }) == "");
      CHECK(difference(at.read(), [&](std::size_t i) {
              const sk::int4 p = kernelIndex(row.r, i);
              const sk::int4 ex = kernelShape(row.x), ey = kernelShape(row.y);
              return sk::int4{std::min(p.x, ex.x - 1), std::min(p.x, ey.x - 1), std::min(p.y, ex.y - 1),
                              std::min(p.y, ey.y - 1)};
            }) == "");
    }
  });
}

TEST_CASE("inputs stretch and stride to the domain by whole ratios") {
  struct Row {
    sk::Shape x, y, z, r;   ///< x is stretched, y strided
  };
  const std::vector<Row> rows = {
      {{7}, {21}, {1}, {7}},
      {{2}, {1021 * 2}, {1}, {1021 * 2}},
      {{5}, {1300}, {1}, {65}},
      {{2, 3}, {8, 18}, {1, 9}, {4, 9}},
      {{13, 1}, {39, 70}, {39, 1}, {39, 35}},
      {{1, 2, 3}, {4, 6, 12}, {1, 1, 1}, {2, 6, 12}},
      {{2, 1, 2, 3}, {4, 3, 8, 6}, {2, 3, 4, 1}, {2, 3, 4, 3}},
  };
  onSomeLayouts([&](sk::Device& device) {
    for (const Row& row : rows) {
      INFO(sk::toString(row.x) << sk::toString(row.y) << sk::toString(row.z) << " to "
                               << sk::toString(row.r));
      const auto numbered = [](const sk::Shape& shape) {
        return HostArray<int>(shape, [](std::size_t i) { return static_cast<int>(i % 1000); });
      };
      const auto x = numbered(row.x), y = numbered(row.y), z = numbered(row.z);
      auto r = device.stream<int>(row.r);
      auto at = device.stream<sk::int4>(row.r);
      streams::repeat(sk::stretch(x.on(device)), sk::stride(y.on(device)), z.on(device), r, at);
      const auto scaled = [&](Position p, const sk::Shape& shape) {
        for (int d = 0; d < shape.rank(); ++d) {
          auto& q = p[static_cast<std::size_t>(d)];
          q = q * shape[d] / row.r[d];   // exact
        }
        return p;
      };
      CHECK(difference(r.read(), [&](std::size_t i) {
              const Position p = positionOf(row.r, i);
              return x[scaled(p, row.x)] + 1000 * y[scaled(p, row.y)] + 1000000 * z.repeated(p);
            }) == "");
      CHECK(difference(at.read(), [&](std::size_t i) {
              const Position p = positionOf(row.r, i);
              const int rank = row.r.rank();
              const auto component = [&](const sk::Shape& shape, int c) {
                const auto q = scaled(p, shape);
                return c < rank ? static_cast<int>(q[static_cast<std::size_t>(rank - 1 - c)]) : 0;
              };
              return sk::int4{component(row.x, 0), component(row.y, 0), component(row.x, 1),
                              component(row.y, 1)};
            }) == "");
    }
    const HostArray<int> u({12, 14}, [](std::size_t i) { return static_cast<int>(i); });
    auto stream = u.on(device);
    auto r = device.stream<int>({4, 6});
    auto at = device.stream<sk::int4>({4, 6});
    streams::repeat(sk::stretch(stream.domain({5, 1}, {7, 4})), sk::stride(stream.domain({4, 2}, {12, 14})),
                    stream.domain({0, 0}, {1, 1}), r, at);
    CHECK(difference(r.read(), [&](std::size_t i) {
            const Position p = positionOf({4, 6}, i);
            return u[{5 + p[0] / 2, 1 + p[1] / 2}] + 1000 * u[{4 + 2 * p[0], 2 + 2 * p[1]}];
          }) == "");
  });
}

TEST_CASE("inputs stretch along one dimension and stride along another") {
  onSomeLayouts([&](sk::Device& device) {
    const HostArray<int> u({2, 15}, [](std::size_t i) { return static_cast<int>(i); });
    const HostArray<int> zero({1, 1}, [](std::size_t) { return 0; });
    auto x = u.on(device), z = zero.on(device);
    auto r = device.stream<int>({4, 5});
    auto at = device.stream<sk::int4>({4, 5});
    const auto fitted = [&](Position p) { return Position{p[0] / 2, p[1] * 3}; };
    streams::repeat(sk::stretch(sk::stride(x)), sk::stride(sk::stretch(x)), z, r, at);
    CHECK(difference(r.read(), [&](std::size_t i) { return 1001 * u[fitted(positionOf({4, 5}, i))]; }) == "");
    CHECK(difference(at.read(), [&](std::size_t i) {
            const Position p = fitted(positionOf({4, 5}, i));
            return sk::int4{static_cast<int>(p[1]), static_cast<int>(p[1]), static_cast<int>(p[0]),
                            static_cast<int>(p[0])};
          }) == "");
  });
}

TEST_CASE("what does not stretch or stride is an error, and nothing is written") {
  sk::Device& device = run_tests::device("glsl330");
  auto x = device.stream<int>({4, 6}), y = device.stream<int>({3, 6}), r = device.stream<int>({4, 6});
  auto at = device.stream<sk::int4>({4, 6});
  r.write(std::vector<int>(24, 7));
  CHECK_THROWS_WITH(
      streams::repeat(x, sk::stretch(y), x, r, at),
      "streams::repeat: 'y' has shape {3, 6}, and the domain {4, 6}; to stretch it, each of its extents "
      "must divide the domain's");
  CHECK_THROWS_WITH(streams::repeat(sk::stride(y), x, x, r, at),
                    Catch::Contains("to stride through it, each of its extents must be a multiple"));
  CHECK_THROWS_WITH(streams::repeat(sk::stretch(sk::stride(y)), x, x, r, at),
                    Catch::Contains("each of its extents must divide the domain's or be a multiple of it"));
  auto none = device.stream<int>({0, 6});
  CHECK_THROWS_AS(streams::repeat(x, sk::stride(none), x, r, at), sk::Error);
  CHECK_THROWS_AS(streams::repeat(x, sk::stretch(sk::stride(none)), x, r, at), sk::Error);
  auto flat = device.stream<int>(24);
  CHECK_THROWS_AS(streams::repeat(x, x, sk::stretch(flat), r, at), sk::Error);
  CHECK(r.read() == std::vector<int>(24, 7));
}

TEST_CASE("a view is written where it is, and nowhere else") {
  struct Row {
    sk::Shape shape;
    sk::Index begin, end;
  };
  const std::vector<Row> rows = {
      {{10}, {3}, {7}},
      {{200}, {60}, {130}},
      {{9, 11}, {2, 3}, {7, 10}},
      {{9, 11}, {0, 0}, {9, 11}},
      {{67, 60}, {1, 2}, {66, 3}},
      {{5, 67}, {4, 0}, {5, 67}},
      {{3, 4, 5}, {1, 1, 1}, {3, 3, 4}},
      {{3, 4, 5}, {0, 2, 0}, {3, 2, 5}},
      {{2, 3, 4, 70}, {1, 0, 2, 5}, {2, 3, 4, 69}},
  };
  onEveryLayout([&](sk::Device& device) {
    for (const Row& row : rows) {
      INFO(sk::toString(row.begin) << " to " << sk::toString(row.end) << " of " << sk::toString(row.shape));
      HostArray<int> expected(row.shape, [](std::size_t i) { return -static_cast<int>(i); });
      auto stream = expected.on(device);
      auto part = stream.domain(row.begin, row.end);
      CHECK(difference(part.read(), [&](std::size_t i) {
              return expected[inside(row.begin, positionOf(part.shape(), i))];
            }) == "");

      streams::fill(42, part);                             // by a kernel
      for (std::size_t i = 0; i < static_cast<std::size_t>(part.size()); ++i) {
        expected[inside(row.begin, positionOf(part.shape(), i))] = 42;
      }
      CHECK(difference(stream.read(), expected.elements()) == "");

      const auto written = values<int>(part.size(), 5);    // from the host
      part.write(written);
      for (std::size_t i = 0; i < written.size(); ++i) {
        expected[inside(row.begin, positionOf(part.shape(), i))] = written[i];
      }
      CHECK(difference(stream.read(), expected.elements()) == "");
      CHECK(difference(part.read(), written) == "");
    }
  });
}

TEST_CASE("views are inputs, and an index in a view begins at 0") {
  onEveryLayout([](sk::Device& device) {
    for (const auto& [shape, begin, end] :
         {std::tuple{sk::Shape{90}, sk::Index{7}, sk::Index{84}},
          std::tuple{sk::Shape{12, 80}, sk::Index{2, 5}, sk::Index{9, 75}},
          std::tuple{sk::Shape{4, 5, 6}, sk::Index{1, 2, 3}, sk::Index{4, 5, 5}}}) {
      INFO(sk::toString(shape));
      const HostArray<int> x(shape, [](std::size_t i) { return static_cast<int>(i); });
      auto xs = x.on(device);
      const auto part = xs.domain(begin, end);
      const auto sum = [&, first = begin](std::size_t i) {
        const int v = x[inside(first, positionOf(part.shape(), i))];
        return v + v;
      };
      auto whole = device.stream<int>(part.shape());
      streams::add(part, part, whole);                     // to a whole stream
      CHECK(difference(whole.read(), sum) == "");
      auto room = device.stream<int>(shape);
      streams::fill(0, room);
      const sk::Index origin = sk::Index::origin(shape.rank());
      sk::Index corner = origin;
      for (int d = 0; d < shape.rank(); ++d) corner[d] = part.shape()[d];
      streams::add(part, whole, room.domain(origin, corner));   // to a view elsewhere
      CHECK(difference(room.domain(origin, corner).read(), [&](std::size_t i) { return sum(i) / 2 * 3; }) ==
            "");

      auto own = device.stream<sk::int4>(shape);
      auto ofX = device.stream<sk::int4>(shape), extent = device.stream<sk::int4>(shape),
           extentOfX = device.stream<sk::int4>(shape);
      const HostArray<float> f(shape, [](std::size_t) { return 0.0f; });
      auto fs = f.on(device);
      streams::where(fs.domain(begin, end), own.domain(begin, end), ofX.domain(begin, end),
                     extent.domain(begin, end), extentOfX.domain(begin, end));
      const auto index = [&](std::size_t i) { return kernelIndex(part.shape(), i); };
      CHECK(difference(own.domain(begin, end).read(), index) == "");
      CHECK(difference(ofX.domain(begin, end).read(), index) == "");
      CHECK(difference(extent.domain(begin, end).read(),
                       [&](std::size_t) { return kernelShape(part.shape()); }) == "");
      CHECK(difference(extentOfX.domain(begin, end).read(),
                       [&](std::size_t) { return kernelShape(part.shape()); }) == "");
    }
  });
}

TEST_CASE("outputs of one call may be views at different places") {
  onSomeLayouts([](sk::Device& device) {
    std::vector<int> n(6 * 70);
    for (std::size_t i = 0; i < n.size(); ++i) n[i] = static_cast<int>(i);
    const sk::Shape shape{6, 70};
    auto a = device.stream<float>({20, 90});
    auto b = device.stream<sk::int3>(shape);
    auto c = device.stream<bool>({6, 71});
    auto d = device.stream<sk::uint2>({7, 70});
    streams::manyOutputs(streamOf<int>(device, shape, n), a.domain({3, 4}, {9, 74}), b,
                         c.domain({0, 1}, {6, 71}), d.domain({1, 0}, {7, 70}));
    CHECK(difference(a.domain({3, 4}, {9, 74}).read(), [](std::size_t i) { return float(i) * 0.5f; }) == "");
    CHECK(difference(b.read(), [](std::size_t i) { return sk::int3{int(i), int(i) + 1, int(i) + 2}; }) == "");
    CHECK(difference(c.domain({0, 1}, {6, 71}).read(), [](std::size_t i) { return std::uint8_t(i & 1u); }) ==
          "");
    CHECK(difference(d.domain({1, 0}, {7, 70}).read(),
                     [](std::size_t i) { return sk::uint2{unsigned(i), 3 * unsigned(i)}; }) == "");
  });
}

TEST_CASE("a call may read and write one stream") {
  onSomeLayouts([](sk::Device& device) {
    for (const sk::Shape& shape : {sk::Shape{100}, sk::Shape{9, 13}, sk::Shape{66, 60}}) {
      INFO(sk::toString(shape));
      const auto x = values<std::int32_t>(shape.size());
      auto stream = streamOf<int>(device, shape, x);
      streams::add(stream, stream, stream);
      streams::add(stream, stream, stream);
      CHECK(difference(stream.read(), [&](std::size_t i) { return static_cast<int>(4u * unsigned(x[i])); }) ==
            "");
    }
    // The views overlap: every element is read before any is written.
    std::vector<int> x(100);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<int>(i);
    auto stream = streamOf<int>(device, x);
    streams::add(stream.domain({0}, {90}), stream.domain({5}, {95}), stream.domain({10}, {100}));
    CHECK(difference(stream.read(), [](std::size_t i) { return i < 10 ? int(i) : int(2 * (i - 10) + 5); }) ==
          "");
    // A broadcast view, with the result in its own stream.
    auto row = streamOf<int>(device, {1, 4}, {1, 2, 3, 4});
    streams::add(row.domain({0, 1}, {1, 2}), row, row);
    CHECK(row.read() == std::vector<int>{3, 4, 5, 6});
  });
}
