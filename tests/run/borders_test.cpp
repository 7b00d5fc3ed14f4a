// SPDX-License-Identifier: MIT
//
// Borders of gathers whose elements are not plain scalars. All results are exact.
#include "borders.sk.hpp"
#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;
using borders::Deep, borders::Hit;
using sk::float2, sk::float2x2, sk::int2, sk::int3;

namespace {

const std::vector<int> borderIndices = {-2147483647 - 1, -3, -1, 0, 1, 2, 3, 4, 5, 6, 7, 100, 2147483647};
const auto indexCount = static_cast<std::int64_t>(borderIndices.size());

bool isSame(const Hit& a, const Hit& b) { return a.t == b.t && a.id == b.id; }

template <class T>
const T& at(const HostArray<T>& a, int i, const T& border) {
  return i >= 0 && i < a.shape()[a.shape().rank() - 1] ? a[{i}] : border;
}

Hit hitAt(std::size_t i) { return {0.5f + float(i), int(i)}; }

}  // namespace

TEST_CASE("borders of structs are written as C++ writes structs") {
  const HostArray<Hit> a({5}, hitAt);
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<Hit>({indexCount}), s = device.stream<Hit>({indexCount});
    const auto stream = a.on(device);
    borders::hits(stream, stream, stream, streamOf<int>(device, borderIndices), r, s);
    const auto first = r.read(), second = s.read();
    for (std::size_t i = 0; i < borderIndices.size(); ++i) {
      const Hit wanted = at(a, borderIndices[i], Hit{1e30f, -1});
      CHECK(isSame(first[i], wanted));
      CHECK(isSame(second[i], wanted));
    }
  });
}

TEST_CASE("each plane of a gather gets its part of the border") {
  const sk::Shape shape{3, 4};
  const HostArray<Deep> a(shape, [](std::size_t i) {
    const auto k = static_cast<float>(i);
    const auto byte = static_cast<std::uint8_t>(i);
    return Deep{hitAt(i),         {{{k, 1}, {2, k}}}, sk::half(k),      {byte, 0, 1},
                sk::unorm8(0.0f), {false, true},      {int(i), 0, 0, 1}};
  });
  const Deep border{{2, 7},           {{{1, 2}, {3, 4}}}, sk::half(0.5f),  {8, 9, 250},
                    sk::unorm8(1.0f), {true, false},      {-5, -5, -5, -5}};
  std::vector<int2> places;
  for (int y = -2; y < 5; ++y) {
    for (int x = -2; x < 6; ++x) places.push_back({x, y});
  }
  const auto check = [&](sk::Device& device) {
    auto r = device.stream<Deep>({static_cast<std::int64_t>(places.size())});
    borders::deep(a.on(device), streamOf<int2>(device, places), r);
    const auto read = r.read();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const int x = places[i].x, y = places[i].y;
      const Deep& wanted = x >= 0 && x < 4 && y >= 0 && y < 3 ? a[{y, x}] : border;
      INFO(x << ", " << y);
      CHECK(isSame(read[i].hit, wanted.hit));
      CHECK(read[i].m == wanted.m);
      CHECK(float(read[i].h) == float(wanted.h));
      CHECK(read[i].c == wanted.c);
      CHECK(float(read[i].u) == float(wanted.u));
      CHECK(read[i].on == wanted.on);
      CHECK(read[i].n == wanted.n);
    }
  };
  onSomeLayouts(check);
  for (const std::string profile : {"glsl330", "essl300"}) {   // each pass writes few planes
    sk::Device device({.profile = profile, .limits = "guaranteed"});
    check(device);
  }
}

TEST_CASE("borders of vectors, matrices and narrow types") {
  const HostArray<float2> a({1, 5}, [](std::size_t i) { return float2{float(i), 2}; });
  const HostArray<float2x2> m({5}, [](std::size_t i) { return float2x2{{{float(i), 1}, {2, 3}}}; });
  const HostArray<int3> n({1, 5, 1}, [](std::size_t i) { return int3{int(i), 8, 9}; });
  const HostArray<sk::half2> h({5},
                               [](std::size_t i) { return sk::half2{sk::half(float(i)), sk::half(1.0f)}; });
  const HostArray<float> f({5}, [](std::size_t i) { return 100 * float(i); });
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<float2>({indexCount});
    auto s = device.stream<float2x2>({indexCount});
    auto t = device.stream<int3>({indexCount});
    borders::vectors(a.on(device), m.on(device), m.on(device), n.on(device), h.on(device), f.on(device),
                     streamOf<int>(device, borderIndices), r, s, t);
    const auto inside = [](int i) { return i >= 0 && i < 5; };
    CHECK(difference(r.read(), [&](std::size_t k) {
            const int i = borderIndices[k];
            const auto x = static_cast<float>(i);
            return inside(i) ? float2{x + x + 100 * x, 2 + 1 + 100 * x}
                             : float2{0 + float(sk::half(0.1f)) + 20, 1 - 3 + 20};
          }) == "");
    const auto sums = s.read();
    for (std::size_t k = 0; k < borderIndices.size(); ++k) {
      const auto x = static_cast<float>(borderIndices[k]);
      CHECK(sums[k] ==
            (inside(borderIndices[k]) ? float2x2{{{2 * x, 2}, {4, 6}}} : float2x2{{{8, 2}, {3, 11}}}));
    }
    CHECK(difference(t.read(), [&](std::size_t k) {
            return inside(borderIndices[k]) ? int3{borderIndices[k], 8, 9} : int3{-1, -2, -3};
          }) == "");
  });
}

TEST_CASE("a template's border is of the type that it is instantiated for") {
  const HostArray<float2> a({5}, [](std::size_t i) { return float2{float(i), 2}; });
  const HostArray<Hit> b({5}, hitAt);
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<float2>({indexCount});
    auto s = device.stream<Hit>({indexCount});
    const auto i = streamOf<int>(device, borderIndices);
    borders::outside_3(a.on(device), i, r);
    borders::outside_5(b.on(device), i, s);
    CHECK(difference(r.read(), [&](std::size_t k) { return at(a, borderIndices[k], float2{3, 4}); }) == "");
    const auto hits = s.read();
    for (std::size_t k = 0; k < borderIndices.size(); ++k)
      CHECK(isSame(hits[k], at(b, borderIndices[k], Hit{5, 6})));
  });
}
