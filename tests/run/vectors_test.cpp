// SPDX-License-Identifier: MIT
//
// Vectors against plain C++ on their components. Floats are small multiples of 1/256 and no operation rounds, so all results
// are exact.
#include "vectors.sk.hpp"

#include <functional>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::bool3, sk::bool4, sk::float2, sk::float4, sk::int2, sk::int3, sk::int4, sk::uint3, sk::uint4;

namespace {

constexpr std::int64_t count = 257;

/// Applies f to each component of the arguments.
template <class F, class... V>
auto by4(const F& f, const V&... v) {
  using R = decltype(f(v.x...));
  return sk::Vector4<R>{f(v.x...), f(v.y...), f(v.z...), f(v.w...)};
}
template <class F, class... V>
auto by3(const F& f, const V&... v) {
  using R = decltype(f(v.x...));
  return sk::Vector3<R>{f(v.x...), f(v.y...), f(v.z...)};
}

template <class T>
sk::Stream<T> made(sk::Device& device) {
  return device.stream<T>({count});
}

}  // namespace

TEST_CASE("swizzles read components in any order") {
  const auto v = values<float4>(count);
  const auto n = values<int3>(count);
  onGlAndNative([&](sk::Device& device) {
    auto a = made<float4>(device), b = made<float4>(device);
    auto c = made<int4>(device);
    auto d = made<float>(device);
    vectors::swizzles(streamOf<float4>(device, v), streamOf<int3>(device, n), a, b, c, d);
    CHECK(difference(a.read(), [&](std::size_t i) {
            const auto [x, y, z, w] = v[i];
            return float4{w + x * 10 + x * 100, z + x * 10 + w * 100, y + y * 10 + z * 100,
                          x + y * 10 + y * 100};
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            const auto [x, y, z, w] = v[i];
            return float4{x + x * 10, x + y * 10, w + z * 10, y + w * 10};
          }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            const auto sum = [](int p, int q) { return static_cast<int>(unsigned(p) + 2u * unsigned(q)); };
            const auto [x, y, z] = n[i];
            return int4{sum(z, x), sum(z, y), sum(y, z), sum(x, x)};
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t i) { return v[i].y + v[i].w * 2 + v[i].w * 4; }) == "");
  });
}

TEST_CASE("swizzles and parts can be assigned to") {
  const auto v = values<float4>(count);
  auto n = values<int2>(count);
  for (auto& k : n) k = {k.x & 1023, k.y & 1023};
  onGlAndNative([&](sk::Device& device) {
    auto a = made<float4>(device), b = made<float4>(device), c = made<float4>(device);
    auto d = made<int2>(device);
    vectors::stores(streamOf<float4>(device, v), streamOf<int2>(device, n), a, b, c, d);
    CHECK(difference(a.read(), [&](std::size_t i) {
            const float4 s = v[i];
            return float4{1 * 3 - 1, s.w * 3 - 2, s.x - 3, s.w + 2};
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            const float4 s = v[i];
            return float4{6, s.z + 1, s.x - 1, 5};
          }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            const float4 s = v[i];
            float4 list[2] = {s, {s.z, s.x, s.z, float(n[i].y)}};
            const int k = n[i].x & 1;
            list[k].x = list[1 - k].y;
            list[k].w = list[1 - k].z;
            list[k].z *= 2;
            return by4([](float p, float q) { return p + q * 10; }, list[0], list[1]);
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t i) {
            const int sum = n[i].x + n[i].y;
            return int2{sum, sum + 1};
          }) == "");
  });
}

TEST_CASE("components can be chosen by a number that is not constant") {
  const auto v = values<float4>(count);
  auto n = values<int>(count);
  for (int& k : n) k &= 0xffff;
  onGlAndNative([&](sk::Device& device) {
    auto a = made<float4>(device);
    auto b = made<float>(device);
    auto c = made<int3>(device);
    auto d = made<bool4>(device);
    vectors::components(streamOf<float4>(device, v), streamOf<int>(device, n), a, b, c, d);
    const auto component = [&](std::size_t i, int k) {
      return std::array{v[i].x, v[i].y, v[i].z, v[i].w}[std::size_t(k)];
    };
    CHECK(difference(a.read(), [&](std::size_t i) {
            float s[4] = {v[i].x, v[i].y, v[i].z, v[i].w};
            const int k = n[i] & 3;
            s[k] = 100;
            s[(k + 1) & 3] += s[k];
            s[3 - k]++;
            return float4{s[0], s[1], s[2], s[3]};
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            const int k = n[i] & 3;
            return component(i, k) + v[i].x * 10 + component(i, 3 - k) * 100 + component(i, 1 + (k & 1));
          }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            int k[3] = {1, 2, 3};
            for (int j = 0; j < 3; ++j) k[j] = k[2 - j] * 10 + j;
            k[n[i] % 3 == 0 ? 2 : 1] -= 5;
            return int3{k[0], k[1], k[2]};
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t i) {
            bool s[4] = {};
            const int k = n[i] & 3;
            s[k] = true;
            s[(k + 2) & 3] = component(i, k) > 0;
            return bool4{s[0], s[1], s[2], s[3]};
          }) == "");
  });
}

TEST_CASE("vectors are made of scalars and vectors") {
  const auto v = values<float2>(count);
  auto n = values<int>(count);
  for (int& k : n) k = k % 1000;
  onGlAndNative([&](sk::Device& device) {
    auto a = made<float4>(device), b = made<float4>(device), c = made<float4>(device);
    auto d = made<int4>(device);
    vectors::constructors(streamOf<float2>(device, v), streamOf<int>(device, n), a, b, c, d);
    CHECK(difference(a.read(), [&](std::size_t i) {
            const float k = float(n[i]);
            return float4{v[i].x * 101 + k * 10, v[i].y * 101 + k * 10, 1 + k * 10 + 200, k * 11 + 300};
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            return float4{v[i].x + v[i].y + 2, 4 + v[i].x, v[i].y * 2 + 2, 2 + v[i].x};
          }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            const float g = (v[i].x + v[i].y + float(n[i])) / 4 + 1.5f;
            return float4{g, g, g, 1};
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t i) {
            return int4{(n[i] + (v[i].x > 0)) * 2, 8, 20, (n[i] + 7) * 2};
          }) == "");
  });
}

TEST_CASE("operators work by components, and with scalars") {
  const auto v = values<float4>(count), w = values<float4>(count, 1);
  const auto s = values<float>(count, 2);
  onGlAndNative([&](sk::Device& device) {
    auto a = made<float4>(device), b = made<float4>(device), c = made<float4>(device),
         d = made<float4>(device);
    vectors::floats(streamOf<float4>(device, v), streamOf<float4>(device, w), streamOf<float>(device, s), a,
                    b, c, d);
    const auto expect = [&](const auto& f) {
      return
          [&, f](std::size_t i) { return by4([&](float p, float q) { return f(p, q, s[i]); }, v[i], w[i]); };
    };
    CHECK(difference(a.read(), expect([](float p, float q, float r) {
                       return p * q + r * p - q / 4 + (1 - p);
                     })) == "");
    CHECK(difference(b.read(), expect([](float p, float q, float r) {
                       return -p + (p - q) * (p + q) - (q - (p - r));
                     })) == "");
    CHECK(difference(c.read(), expect([](float p, float q, float r) { return ((p + q) * r - 1) / 2 * 4; })) ==
          "");
    CHECK(difference(d.read(), [&](std::size_t i) {
            const float4 e = by4([&](float p) { return 2 * p + s[i] + w[i].x * v[i].y; }, v[i]);
            return float4{e.y, e.x, e.w, e.z};
          }) == "");
  });
}

TEST_CASE("integer operators work by components, and with scalars") {
  auto v = values<int4>(count), w = values<int4>(count, 1);
  auto s = values<int>(count, 2);
  for (auto* list : {&v, &w}) {
    for (int4& k : *list) k = by4([](int p) { return p % 100000; }, k);
  }
  for (int& k : s) k &= 0xffff;
  onGlAndNative([&](sk::Device& device) {
    auto a = made<int4>(device), b = made<int4>(device), c = made<int4>(device), d = made<int4>(device);
    vectors::ints(streamOf<int4>(device, v), streamOf<int4>(device, w), streamOf<int>(device, s), a, b, c, d);
    const auto expect = [&](const auto& f) {
      return [&, f](std::size_t i) { return by4([&](int p, int q) { return f(p, q, s[i]); }, v[i], w[i]); };
    };
    CHECK(difference(a.read(), expect([](int p, int q, int r) {
                       return p + q * 3 - r + (p ^ q) + (p & 0xff) - (15 | q);
                     })) == "");
    CHECK(difference(b.read(), expect([](int p, int q, int r) {
                       const int o = (q & 255) + 1;
                       return p / o + p % o + p / 5 + r % o;
                     })) == "");
    CHECK(difference(c.read(), expect([](int p, int q, int) {
                       const int u = q & 7;
                       return (p << u) ^ (p >> u) ^ (p >> 3) ^ ~q ^ (1 << u);
                     })) == "");
    CHECK(difference(d.read(), expect([](int p, int q, int r) {
                       int e = ((p + q - 1) ^ p) << 1;
                       e >>= q & 7;
                       return -((e | 4) & ~r);
                     })) == "");
  });
}

TEST_CASE("uint operators wrap by components") {
  const auto v = values<uint4>(count), w = values<uint4>(count, 1);
  const auto s = values<std::uint32_t>(count, 2);
  onGlAndNative([&](sk::Device& device) {
    auto a = made<uint4>(device), b = made<uint4>(device);
    vectors::uints(streamOf<uint4>(device, v), streamOf<uint4>(device, w), streamOf<std::uint32_t>(device, s),
                   a, b);
    CHECK(difference(a.read(), [&](std::size_t i) {
            return by4(
                [&](unsigned p, unsigned q) {
                  const unsigned u = q & 31u, o = q | 1u;
                  return (p << u) + (p >> u) * 3u + p / o - p % o + (p ^ s[i]) + -q;
                },
                v[i], w[i]);
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            return by4(
                [](unsigned p, unsigned q) { return ((p * q + 0xffffffffu) >> (q & 31u)) % 1000u + ~p; },
                v[i], w[i]);
          }) == "");
  });
}

TEST_CASE("comparisons of vectors give masks by components") {
  auto v = values<float4>(count), w = values<float4>(count, 1);
  for (std::size_t i = 0; i < v.size(); ++i) {  // makes some components equal
    if (i % 2 == 0) w[i].x = v[i].x;
    if (i % 3 == 0) w[i].z = v[i].z;
    if (i % 7 == 0) w[i] = v[i];
  }
  onGlAndNative([&](sk::Device& device) {
    auto a = made<bool4>(device);
    auto b = made<int4>(device), c = made<int4>(device);
    auto d = made<float4>(device);
    vectors::comparisons(streamOf<float4>(device, v), streamOf<float4>(device, w), a, b, c, d);
    CHECK(difference(a.read(), [&](std::size_t i) {
            return bool4{v[i].x < w[i].x, v[i].y >= w[i].y, v[i].z == w[i].z, v[i].w != w[i].w};
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            return by4(
                [](float p, float q) {
                  return -((p < q) + (p <= q) * 2 + (p > q) * 4 + (p >= q) * 8 + (p == q) * 16 +
                           (p != q) * 32);
                },
                v[i], w[i]);
          }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            const auto [x, y, z, u] = v[i];
            const auto [p, q, r, t] = w[i];
            const bool anyLess = x < p || y < q || z < r || u < t, allLess = x < p && y < q && z < r && u < t;
            const bool anyEqual = x == p || y == q || z == r || u == t;
            const bool bothNegative =
                (x < p && p < 0) || (y < q && q < 0) || (z < r && r < 0) || (u < t && t < 0);
            return int4{anyLess + 2 * allLess + 4 * anyEqual + 8 * !anyEqual, allLess ? 2 : 1,
                        !anyEqual      ? 1
                        : bothNegative ? 2
                                       : 3,
                        (x < r || y < t) + 2 * (x >= q && y >= r && z >= t)};
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t i) {
            const bool first = v[i].x < w[i].x;
            return by4(
                [&](float p, float q) {
                  return (p < q ? p : q) + (p == q ? 100 : 200) + (first ? q : p) * 1000;
                },
                v[i], w[i]);
          }) == "");
  });
}

TEST_CASE("vectors of integers and bools are compared and selected") {
  auto v = values<int3>(count), w = values<int3>(count, 1);
  for (auto* list : {&v, &w}) {
    for (int3& k : *list) k = by3([](int p) { return p % 8; }, k);
  }
  const auto p = values<bool4>(count), q = values<bool4>(count, 1);
  onGlAndNative([&](sk::Device& device) {
    auto a = made<int3>(device), c = made<int3>(device);
    auto b = made<bool3>(device);
    auto d = made<uint3>(device);
    vectors::integerComparisons(streamOf<int3>(device, v), streamOf<int3>(device, w), a, b, c, d);
    CHECK(difference(a.read(), [&](std::size_t i) {
            return by3([](int x, int y) { return std::max(x, y) + (x < 3 ? y : x); }, v[i], w[i]);
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            return bool3{v[i].x < w[i].x, !(v[i].y < w[i].y), v[i].z < w[i].z};
          }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            return int3{v[i].x, v[i].x > 0 ? v[i].y : w[i].y, w[i].z};
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t i) {
            return by3(
                [](int x, int y) {
                  const unsigned r = unsigned(x), s = unsigned(y);
                  return (r < s ? s - r : r - s) + unsigned(r >= s);
                },
                v[i], w[i]);
          }) == "");

    auto ba = made<bool4>(device), bb = made<bool4>(device);
    auto bc = made<int4>(device);
    auto bd = made<bool>(device);
    vectors::bools(streamOf<bool4>(device, p), streamOf<bool4>(device, q), ba, bb, bc, bd);
    CHECK(difference(ba.read(), [&](std::size_t i) {
            return bool4{p[i].x && q[i].x, p[i].y || q[i].y, !p[i].z, p[i].w != q[i].w};
          }) == "");
    CHECK(difference(bb.read(), [&](std::size_t i) { return bool4{p[i].y, p[i].x, q[i].y, q[i].x}; }) == "");
    CHECK(difference(bc.read(), [&](std::size_t i) {
            const bool4 s = p[i], t = q[i];
            return int4{s.x + t.x * 2 + (s.x || s.y || s.z || s.w) * 4,
                        s.y + t.y * 2 + (t.x && t.y && t.z && t.w) * 4, s.z + t.z * 2 + (t.x || t.y) * 4,
                        s.w + t.w * 2 + (s.z && s.w) * 4};
          }) == "");
    CHECK(difference(bd.read(), [&](std::size_t i) {
            const bool4 s = p[i], t = q[i];
            return std::uint8_t(((s.x || t.y || !t.z) && !(s.x && s.y && s.z && s.w)) || t.w);
          }) == "");
  });
}

TEST_CASE("vectors are made with parentheses by qualified names, and for constants") {
  const auto v = values<float2>(50);
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<float4>({50});
    auto b = device.stream<float2>({50});
    vectors::qualified(streamOf<float2>(device, v), a, b);
    CHECK(difference(a.read(), [&](std::size_t i) {
            return float4{v[i].x + 1 + v[i].x * 0.5f, v[i].y + 2 + 0.25f, 3 + 3 + 0.125f, 4 + 4 + 1};
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            return float2{(v[i].x + 3) * 2 + 4 + 12, (v[i].y + 4) * 0.5f + 3 + 14};
          }) == "");
  });
}

TEST_CASE("variables and aliases of vectors are made with parentheses") {
  const auto v = values<float2>(50);
  const auto n = values<int>(50, 1);
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<float4>({50});
    auto b = device.stream<int2>({50});
    auto c = device.stream<float2>({50});
    auto d = device.stream<sk::half2>({50});
    std::vector<int> small;
    for (const int k : n) small.push_back(k % 1000);
    vectors::variables(streamOf<float2>(device, v), streamOf<int>(device, small), a, b, c, d);
    CHECK(difference(a.read(), [&](std::size_t i) {
            const auto k = static_cast<float>(small[i]);
            const float4 colour{1 + 3, v[i].y + 4, v[i].x + k, k};
            return float4{2 * colour.x + v[i].x, colour.y + 1, colour.z + 1, 2 * colour.w + 0.5f};
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            const int k = small[i];
            return int2{(k + 3) * 7 + k + 1, (k + 1 + 3) * 7 + k};
          }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            return float2{(v[i].x + 2 * v[i].y) * 0.5f, (v[i].y + 2 * v[i].x) * 0.5f};
          }) == "");
    const auto halves = d.read();
    for (std::size_t i = 0; i < halves.size(); ++i) {
      CHECK(float(halves[i].x) == 1.5f);
      CHECK(float(halves[i].y) == static_cast<float>(small[i] & 7));
    }
  });
}
