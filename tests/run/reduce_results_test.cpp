// SPDX-License-Identifier: MIT
//
// Results of reduces: several values or streams at once, indices of elements, more planes than a pass writes, matrices and
// storage types, and streams of lower rank. All results are exact.
#include <algorithm>
#include <cmath>
#include <map>

#include "reduce_results.sk.hpp"
#include "support/devices.hpp"
#include "support/folds.hpp"

using namespace run_tests;
using sk::float2, sk::float2x2, sk::float3, sk::int2, sk::int4;

namespace {

std::uint32_t wordAt(std::size_t i) { return valueAt<std::uint32_t>(static_cast<std::uint32_t>(i)); }
/// Distinct floats, up to 65536 of them.
float distinctAt(std::size_t i) {
  return static_cast<float>(static_cast<std::uint32_t>(i) * 40503u % 65536u);
}

const std::vector<sk::Shape> resultShapes = {{1},      {2},      {33},     {1021},     {4093},
                                             {13, 17}, {1, 200}, {200, 1}, {5, 7, 11}, {2, 3, 5, 7}};

/// Every shape, or a line and a plane of several passes each: the other ranks read elements by the same functions.
std::vector<sk::Shape> resultShapesOn(const sk::Device& device) {
  return takesAllCases(device) ? resultShapes : std::vector<sk::Shape>{{4093}, {13, 17}};
}

std::size_t sizeOf(const sk::Shape& shape) { return static_cast<std::size_t>(shape.size()); }

int4 indexAt(const sk::Shape& shape, std::size_t i) {
  const Position p = positionOf(shape, i);
  int4 index{0, 0, 0, 0};
  int* const components[] = {&index.x, &index.y, &index.z, &index.w};
  for (int d = 0; d < shape.rank(); ++d) {
    *components[d] = static_cast<int>(p[static_cast<std::size_t>(shape.rank() - 1 - d)]);
  }
  return index;
}

bool sameBest(const std::vector<results::Best>& a, const std::vector<results::Best>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const results::Best& x, const results::Best& y) { return x.value == y.value && x.at == y.at; });
}

/// A device that writes four planes in a pass.
sk::Device& narrowDevice(const std::string& profile) {
  // Never destroyed: some drivers shut down before our static objects are destroyed.
  static auto& devices = *new std::map<std::string, sk::Device>;
  auto found = devices.find(profile);
  if (found == devices.end()) {
    found = devices.emplace(profile, sk::Device({.profile = profile, .limits = "guaranteed"})).first;
  }
  return found->second;
}

}  // namespace

TEST_CASE("several accumulators come as a tuple, or as streams") {
  onSomeLayouts([](sk::Device& device) {
    for (const sk::Shape& shape : resultShapesOn(device)) {
      INFO(sk::toString(shape));
      const HostArray<float> x(shape, smallAt);
      float sum = 0, squares = 0, least = INFINITY, most = -INFINITY;
      for (const float v : x.elements()) {
        sum += v;
        squares += v * v;
        least = std::min(least, v);
        most = std::max(most, v);
      }
      const auto stream = x.on(device);
      const auto [s, q, lo, hi] = results::stats(stream);
      CHECK((s == sum && q == squares && lo == least && hi == most));
      sk::Shape one = shape;
      for (int d = 0; d < one.rank(); ++d) one = one.with(d, 1);
      auto a = device.stream<float>(one), b = device.stream<float>(one), c = device.stream<float>(one);
      auto room = device.stream<float>(shape);
      const auto d = room.domain(sk::Index::origin(shape.rank()), [&] {
        sk::Index end = sk::Index::origin(shape.rank());
        for (int k = 0; k < shape.rank(); ++k) end[k] = 1;
        return end;
      }());
      results::stats(stream, a, b, c, d);
      CHECK((a.read()[0] == sum && b.read()[0] == squares && c.read()[0] == least && d.read()[0] == most));
    }
    const auto [s, q, lo, hi] = results::stats(device.stream<float>({0, 3}));
    CHECK((s == 0 && q == 0 && lo == INFINITY && hi == -INFINITY));
  });
}

TEST_CASE("accumulators of several types, in order, combined by an overload or by themselves") {
  onSomeLayouts([](sk::Device& device) {
    for (const sk::Shape& shape : resultShapesOn(device)) {
      INFO(sk::toString(shape));
      const HostArray<std::uint32_t> x(shape, wordAt);
      results::Affine expected{1, 0};
      bool isOdd = false;
      for (const std::uint32_t v : x.elements()) {
        expected = {31u * expected.a, 31u * expected.b + v};
        isOdd = isOdd != ((v & 1u) != 0u);
      }
      const auto [f, n, odd] = results::mixed(x.on(device));
      CHECK((f.a == expected.a && f.b == expected.b));
      CHECK(n == static_cast<int>(sizeOf(shape)));
      CHECK(odd == isOdd);

      const HostArray<float> y(shape, distinctAt);
      const HostArray<int> at(shape, [](std::size_t i) { return static_cast<int>(i); });
      const auto [least, where] = results::leastAt(y.on(device), at.on(device));
      const auto found = std::min_element(y.elements().begin(), y.elements().end());
      CHECK(least == *found);
      CHECK(where == found - y.elements().begin());
      const auto [first, last] = results::firstAndLast(at.on(device), at.on(device));
      CHECK((first == 0 && last == static_cast<int>(sizeOf(shape)) - 1));
    }
    CHECK_THROWS_AS(results::leastAt(device.stream<float>({0}), device.stream<int>({0})), sk::Error);
  });
}

TEST_CASE("the index is the element's in its input, in views and for blocks, too") {
  onEveryLayout([](sk::Device& device) {
    for (const sk::Shape& shape : resultShapes) {
      INFO(sk::toString(shape));
      const HostArray<float> x(shape, distinctAt);
      const auto least = std::min_element(x.elements().begin(), x.elements().end());
      const auto most = std::max_element(x.elements().begin(), x.elements().end());
      const results::Best best = results::argmin(x.on(device));
      CHECK(best.value == *least);
      CHECK(best.at == indexAt(shape, static_cast<std::size_t>(least - x.elements().begin())));
      const auto [value, at] = results::argmax(x.on(device));
      CHECK((value == *most && at == most - x.elements().begin()));
    }
    const HostArray<float> x({24, 90}, distinctAt);
    auto stream = x.on(device);
    auto rows = device.stream<results::Best>({4, 3});
    results::argmin(stream, rows);
    const auto found = rows.read();
    for (std::int64_t block = 0; block < 12; ++block) {
      Position best{block / 3 * 6, block % 3 * 30};
      for (std::int64_t i = 0; i < 180; ++i) {
        const Position p{block / 3 * 6 + i / 30, block % 3 * 30 + i % 30};
        if (x[p] < x[best]) best = p;
      }
      const int4 at{static_cast<int>(best[1]), static_cast<int>(best[0]), 0, 0};
      CHECK(found[static_cast<std::size_t>(block)].at == at);
    }
    const auto view = stream.domain({3, 7}, {20, 77});
    const auto inView = view.read();
    const auto least = std::min_element(inView.begin(), inView.end()) - inView.begin();
    CHECK(results::argmin(view).at == int4{static_cast<int>(least % 70), static_cast<int>(least / 70), 0, 0});
    CHECK(std::get<1>(results::argmax(device.stream<float>({0, 3}))) == -1);
  });
}

TEST_CASE("places of several inputs, of which some repeat, and the weights that they choose") {
  onSomeLayouts([](sk::Device& device) {
    const HostArray<std::uint32_t> x({14, 50}, wordAt),
        y({1, 50}, [](std::size_t i) { return wordAt(i + 5); });
    std::uint32_t expected = 0;
    for (int row = 0; row < 14; ++row) {
      for (int column = 0; column < 50; ++column) {
        const int p = column + 3 * column + 50, q = row + 1, r = 1, s = 1;
        expected +=
            (x[{row, column}] ^ y[{0, column}]) * static_cast<std::uint32_t>(p + 5 * q + 7 * r + 11 * s);
      }
    }
    CHECK(results::checksum(x.on(device), y.on(device)) == expected);
    const HostArray<float> v({1021}, smallAt), w({1021}, [](std::size_t i) { return smallAt(3 * i); });
    float moment = 0;
    for (std::size_t i = 0; i < 1021; ++i) moment += v.elements()[i] * w.elements()[i];
    CHECK(results::moment(v.on(device), w.on(device)) == moment);
  });
}

TEST_CASE("more planes than a pass writes") {
  for (const std::string profile : {"glsl330", "essl300"}) {
    for (sk::Device* device : {&narrowDevice(profile), &run_tests::device(profile)}) {
      INFO(profile << ": " << device->limits().drawBuffers << " draw buffers");
      const HostArray<int> x({37, 60},
                             [](std::size_t i) { return static_cast<int>(wordAt(i) % 4096) - 100; });
      results::Many m{
          0, {-INFINITY, -INFINITY, -INFINITY, -INFINITY}, {0, 0}, 0, false, {INFINITY, INFINITY, INFINITY}};
      results::Many n{INFINITY, {0, 0, 0, 0}, {INT32_MIN, INT32_MIN}, 0, false, {0, 0, 0}};
      for (const int v : x.elements()) {
        m.a += static_cast<float>(v & 7);
        m.b.x = std::max(m.b.x, static_cast<float>(v & 31));
        m.c = {m.c.x + v, m.c.y - v};
        m.d ^= static_cast<std::uint32_t>(v);
        m.e = m.e || v == 12345;
        m.f.z = std::min(m.f.z, static_cast<float>(v & 15));
        n.a = std::min(n.a, static_cast<float>(v & 63));
        n.b.w += static_cast<float>(v & 1);
        n.c = {std::max(n.c.x, v), std::max(n.c.y, -v)};
        n.d |= static_cast<std::uint32_t>(v & 4);
        n.e = n.e || v < 0;
        n.f.y += static_cast<float>(v & 3);
      }
      const auto check = [&](const results::Many& a, int last, const results::Many& b) {
        CHECK((a.a == m.a && a.b.x == m.b.x && a.b.w == m.b.x + 3 && a.c == m.c && a.d == m.d && a.e == m.e &&
               a.f.z == m.f.z));
        CHECK(last == 37 * 60);
        CHECK((b.a == n.a && b.b.w == n.b.w && b.c == n.c && b.d == n.d && b.e == n.e && b.f.y == n.f.y));
      };
      const auto [a, last, b] = results::tenPlanes(x.on(*device));
      check(a, last, b);
      auto as = device->stream<results::Many>({1, 1}), bs = device->stream<results::Many>({1, 1});
      auto lasts = device->stream<int>({1, 1});
      results::tenPlanes(x.on(*device), as, lasts, bs);
      check(as.read()[0], lasts.read()[0], bs.read()[0]);
      const auto [e, none, f] = results::tenPlanes(device->stream<int>({0}));
      CHECK((e.a == 0 && none == 0 && f.a == INFINITY && f.f.y == 0));
    }
  }
}

TEST_CASE("products of matrices keep the order of 10007 factors") {
  onSomeLayouts([](sk::Device& device) {
    const std::int64_t n = device.limits().textureSize <= smallLimits[0] ? 4093 : 10007;
    const HostArray<float2x2> m({n}, [](std::size_t i) {
      const auto at = [&](std::size_t k) { return static_cast<float>(wordAt(4 * i + k) % 251u); };
      return float2x2{{{at(0), at(1)}, {at(2), at(3)}}};
    });
    const auto times = [](const float2x2& a, const float2x2& b) {
      const auto dot = [&](int r, int c) {
        const float x = a[r].x * (c == 0 ? b[0].x : b[0].y), y = a[r].y * (c == 0 ? b[1].x : b[1].y);
        return std::fmod(x + y, 251.0f);
      };
      return float2x2{{{dot(0, 0), dot(0, 1)}, {dot(1, 0), dot(1, 1)}}};
    };
    float2x2 expected = m.elements()[0];
    for (std::size_t i = 1; i < m.elements().size(); ++i) expected = times(expected, m.elements()[i]);
    CHECK(results::exactProduct(m.on(device)) == expected);
    // Shears and a quarter turn, whose products are exact.
    const HostArray<float2x2> steps({n}, [](std::size_t i) {
      return i % 3 == 0   ? float2x2{{{0, -1}, {1, 0}}}
             : i % 3 == 1 ? float2x2{{{1, 2}, {0, 1}}}
                          : float2x2{{{1, -2}, {0, 1}}};
    });
    const auto plain = [](const float2x2& a, const float2x2& b) {
      return float2x2{{{a[0].x * b[0].x + a[0].y * b[1].x, a[0].x * b[0].y + a[0].y * b[1].y},
                       {a[1].x * b[0].x + a[1].y * b[1].x, a[1].x * b[0].y + a[1].y * b[1].y}}};
    };
    float2x2 walked{{{1, 0}, {0, 1}}};
    for (const float2x2& step : steps.elements()) walked = plain(walked, step);
    CHECK(results::product(steps.on(device)) == walked);
    CHECK(results::productFrom(steps.on(device)) == walked);
    CHECK(results::productFrom(device.stream<float2x2>({0})) == float2x2{{{1, 0}, {0, 1}}});
    const auto sum = results::sumOf(streamOf<float3>(device, std::vector<float3>(1021, float3{1, 2, 3})));
    CHECK((sum[0] == float3{1021, 2042, 3063} && sum[2] == float3{3063, 6126, 9189}));
  });
}

TEST_CASE("narrow types fold as they do in C++") {
  onEveryTarget([](sk::Device& device) {
    const HostArray<float> x({4093}, [](std::size_t i) { return static_cast<float>(wordAt(i) % 90u); });
    int sum = 0;
    float most = 0, least = 100;
    for (const float v : x.elements()) {
      sum += static_cast<int>(v);
      most = std::max(most, v);
      least = std::min(least, v);
    }
    const results::Small s = results::small(x.on(device));
    CHECK(static_cast<float>(s.most) == most);
    CHECK(int{s.sum} == (sum & 255));
    CHECK(s.least.integer() == sk::snorm16(least / 100).integer());
    CHECK(s.count == 4093);
    const results::Small none = results::small(device.stream<float>({0}));
    CHECK(
        (static_cast<float>(none.most) == -INFINITY && none.sum == 0 && static_cast<float>(none.least) == 1));

    std::vector<sk::half> halves(1000, sk::half(0.5f));
    CHECK(static_cast<float>(results::halves(streamOf<sk::half>(device, halves))) == 500);
    std::vector<sk::unorm8> lights(777, sk::unorm8(0.25f));
    lights[500] = sk::unorm8(0.75f);
    CHECK(results::brightest(streamOf<sk::unorm8>(device, lights)).integer() == sk::unorm8(0.75f).integer());
    const auto bytes =
        results::bytes(streamOf<sk::uchar4>(device, std::vector<sk::uchar4>(300, {1, 2, 3, 255})));
    CHECK((bytes.x == 44 && bytes.y == 88 && bytes.z == 132 && bytes.w == 212));

    std::vector<results::Posed> poses(1021);
    float2x2 turn{{{1, 0}, {0, 1}}};
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i] = {{{{1, static_cast<float>(i % 7)}, {0, 1}}}, sk::half(static_cast<float>(i % 100)), 3};
      turn[0].y = std::fmod(turn[0].y + static_cast<float>(i % 7), 251.0f);
    }
    const results::Posed pose = results::pose(streamOf<results::Posed>(device, poses));
    CHECK(pose.turn == turn);
    CHECK((static_cast<float>(pose.weight) == 99 && pose.count == ((3 * 1021) & 255)));
  });
}

TEST_CASE("instances of templates") {
  onGlAndNative([](sk::Device& device) {
    const auto [sum, most] =
        results::both(streamOf<int>(device, {1, 2, 3, 4}), streamOf<int>(device, {5, 6, -7, 8}));
    CHECK((sum == 5 + 12 - 21 + 32 && most == 8));
    const auto [product, largest] =
        results::both(streamOf<float>(device, {0.5f}), streamOf<float>(device, {4}));
    CHECK((product == 2 && largest == 4));
  });
}

TEST_CASE("streams of fewer dimensions take what remains without extents of 1") {
  onGlAndNative([](sk::Device& device) {
    const HostArray<float> x({20, 90}, smallAt);
    const auto stream = x.on(device);
    const auto compare = [&](const sk::Shape& shape, const sk::Shape& meant) {
      INFO(sk::toString(shape) << " for " << sk::toString(meant));
      std::vector<sk::Stream<float>> less, same;
      for (int i = 0; i < 4; ++i) {
        less.push_back(device.stream<float>(shape));
        same.push_back(device.stream<float>(meant));
      }
      results::stats(stream, less[0], less[1], less[2], less[3]);
      results::stats(stream, same[0], same[1], same[2], same[3]);
      for (std::size_t i = 0; i < 4; ++i) CHECK(difference(less[i].read(), same[i].read()) == "");
      auto best = device.stream<results::Best>(shape), expected = device.stream<results::Best>(meant);
      results::argmin(stream, best);
      results::argmin(stream, expected);
      CHECK(sameBest(best.read(), expected.read()));
    };
    compare({20}, {20, 1});
    compare({90}, {1, 90});
    compare({4}, {4, 1});
    compare({45}, {1, 45});
    compare({1}, {1, 1});
    auto ambiguous = device.stream<results::Best>({10});
    CHECK_THROWS_WITH(
        results::argmin(stream, ambiguous),
        "results::argmin: 'x' has shape {20, 90}, and the output 'best' has {10}, which could mean "
        "{10, 1} or {1, 10}; write the one that you mean");
    const HostArray<float> box({4, 15, 14}, smallAt);
    auto planes = device.stream<results::Best>({15, 14}), boxed = device.stream<results::Best>({1, 15, 14});
    results::argmin(box.on(device), planes);
    results::argmin(box.on(device), boxed);
    CHECK(sameBest(planes.read(), boxed.read()));
  });
}
