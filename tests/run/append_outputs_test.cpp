// SPDX-License-Identifier: MIT
//
// Variable and scatter outputs with every kind of element, against plain C++. All results are exact.
#include "append_outputs.sk.hpp"

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using append_outputs::Dot;
using sk::half, sk::int2, sk::float3;

namespace {

Dot dotAt(int i) {
  const auto f = static_cast<float>(i);
  return {{half(f), half(-f / 2)},
          {sk::unorm8(1.0f), sk::unorm8(0.0f), sk::unorm8::fromInteger(static_cast<std::uint8_t>(i)),
           sk::unorm8(1.0f)},
          static_cast<std::uint8_t>(i % 4),
          {{{f, 1}, {-1, f + 1}}}};
}

bool isSameDot(const Dot& a, const Dot& b) {
  return a.at == b.at && a.colour == b.colour && a.kind == b.kind && a.turn == b.turn;
}

template <class T>
std::vector<T> everyThird(const std::vector<T>& x) {
  std::vector<T> list;
  for (std::size_t i = 0; i < x.size(); i += 3) list.push_back(x[i]);
  return list;
}

constexpr int count = 257;

}  // namespace

TEST_CASE("structs of narrow types and matrices are pushed and scattered") {
  std::vector<Dot> dots, kept, placed(count);
  std::vector<int> at;
  for (int i = 0; i < count; ++i) {
    dots.push_back(dotAt(i));
    if (i % 4 > 1) kept.push_back(dotAt(i));
    at.push_back((i * 100) % count);
    placed[static_cast<std::size_t>(at.back())] = dotAt(i);
  }
  onDrawnLayouts([&](sk::Device& device) {
    const auto d = streamOf<Dot>(device, dots);
    auto r = device.stream<Dot>({0}), s = device.stream<Dot>({count});
    append_outputs::kept(d, r);
    append_outputs::placed(streamOf<int>(device, at), d, s);
    const auto pushed = r.read(), scattered = s.read();
    CHECK(std::equal(pushed.begin(), pushed.end(), kept.begin(), kept.end(), isSameDot));
    CHECK(std::equal(scattered.begin(), scattered.end(), placed.begin(), placed.end(), isSameDot));
  });
}

TEST_CASE("what is pushed or stored in a narrow type is converted to it") {
  std::vector<int2> at;
  std::vector<sk::char4> x;
  std::vector<std::int16_t> y;
  for (int i = 0; i < 12 * 20; ++i) {
    at.push_back({i % 20, 11 - i / 20});
    const auto c = static_cast<std::int8_t>(i);
    x.push_back({c, 100, -100, 7});
    y.push_back(static_cast<std::int16_t>(i * 331));
  }
  onDrawnLayouts([&](sk::Device& device) {
    auto r = device.stream<sk::char4>({12, 20});
    auto s = device.stream<std::int16_t>({12, 20});
    auto t = device.stream<std::uint8_t>({0});
    auto u = device.stream<half>({0});
    append_outputs::wrapped(streamOf<int2>(device, at), streamOf<sk::char4>(device, x),
                            streamOf<std::int16_t>(device, y), r, s, t, u);
    const auto from = [](std::size_t k) { return (11 - k / 20) * 20 + k % 20; };
    CHECK(difference(r.read(), [&](std::size_t k) {
            const auto c = static_cast<std::int8_t>(2 * x[from(k)].x);
            return sk::char4{c, -56, 56, 14};
          }) == "");
    CHECK(difference(s.read(), [&](std::size_t k) { return static_cast<std::int16_t>(y[from(k)] * 3); }) ==
          "");
    CHECK(difference(t.read(), [&](std::size_t k) {
            return static_cast<std::uint8_t>(y[k / 2] + (k % 2 == 0 ? 0 : 200));
          }) == "");
    CHECK(t.size() == 480);
    CHECK(difference(u.read(), [&](std::size_t k) { return half(static_cast<float>(y[k]) * 0.3f); }) == "");
  });
}

TEST_CASE("templates with append outputs, for each value of a constant") {
  const auto f = values<float>(count);
  std::vector<sk::half3> h;
  std::vector<sk::float3x3> m;
  for (const float v : f) {
    h.push_back({half(v), half(-v), half(1.0f)});
    m.push_back({{{v, 1, 2}, {3, v, 4}, {5, 6, -v}}});
  }
  onDrawnLayouts([&](sk::Device& device) {
    auto r = device.stream<float>({0});
    auto s = device.stream<sk::half3>({0});
    auto t = device.stream<sk::float3x3>({0});
    append_outputs::everyNth(streamOf<float>(device, f), 1, r);
    CHECK(r.read() == f);
    append_outputs::everyNth(streamOf<float>(device, f), 3, r);
    append_outputs::everyNth(streamOf<sk::half3>(device, h), 3, s);
    append_outputs::everyNth(streamOf<sk::float3x3>(device, m), 3, t);
    CHECK(r.read() == everyThird(f));
    CHECK(s.read() == everyThird(h));
    CHECK(t.read() == everyThird(m));
  });
}

TEST_CASE("scatters of templates") {
  std::vector<int> at;
  std::vector<std::uint32_t> u(7), sums(7);
  std::vector<int2> v, pairs(7);
  u.clear();
  for (int i = 0; i < count; ++i) {
    at.push_back(i % 7);
    u.push_back(hashed(static_cast<std::uint32_t>(i)));
    v.push_back({i, -i});
    const auto k = static_cast<std::size_t>(i % 7);
    sums[k] += u.back();
    pairs[k] = {pairs[k].x + i, pairs[k].y - i};
  }
  onDrawnLayouts([&](sk::Device& device) {
    const auto a = streamOf<int>(device, at);
    auto r = streamOf<std::uint32_t>(device, std::vector<std::uint32_t>(7));
    auto s = streamOf<int2>(device, std::vector<int2>(7));
    append_outputs::added(a, streamOf<std::uint32_t>(device, u), r);
    append_outputs::added(a, streamOf<int2>(device, v), s);
    CHECK(r.read() == sums);
    CHECK(s.read() == pairs);
  });
}

TEST_CASE("append outputs of a domain that only iterators know") {
  constexpr std::int64_t height = 9, width = 13;
  onDrawnLayouts([&](sk::Device& device) {
    for (const unsigned kind : {0u, 1u, 2u}) {   // Pushes, Sums, Both
      INFO("kind " << kind);
      auto r = device.stream<float3>({0});
      auto s = streamOf<int2>(device, std::vector<int2>(width));
      append_outputs::ramps(kind, sk::iter(int2{0, 0}, int2{width, height}, {height, width}),
                            sk::iter(0.0f, 117.0f), r, s);
      const bool pushes = kind != 1, sums = kind != 0;
      CHECK(r.size() == (pushes ? height * width : 0));
      CHECK(difference(r.read(), [&](std::size_t i) {
              return float3{static_cast<float>(i % 13), static_cast<float>(i / 13), static_cast<float>(i)};
            }) == "");
      CHECK(difference(s.read(), [&](std::size_t i) {
              return sums ? int2{static_cast<int>(i) * 9, 36} : int2{0, 0};
            }) == "");
    }
  });
}
