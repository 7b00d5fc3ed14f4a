// SPDX-License-Identifier: MIT
//
// Intrinsics other than plain functions of floats: geometry, several results, bits, integers, comparisons, mixes of scalars
// and vectors.
#include <bit>
#include <cmath>
#include <limits>

#include "intrinsics.sk.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::bool3, sk::bool4, sk::float2, sk::float3, sk::float4, sk::int3, sk::int4, sk::uint4;

namespace {

constexpr std::int64_t kindCount = 200;

template <class F, class... V>
auto by4(const F& f, const V&... v) {
  using R = decltype(f(v.x...));
  return sk::Vector4<R>{f(v.x...), f(v.y...), f(v.z...), f(v.w...)};
}

struct Double3 {
  double x, y, z;
};
Double3 of(const float4& v) { return {v.x, v.y, v.z}; }
double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Double3 sum(const Double3& a, double s, const Double3& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
Double3 scaled(double s, const Double3& a) { return {s * a.x, s * a.y, s * a.z}; }
Double3 normal(const Double3& a) { return scaled(1 / std::sqrt(dot(a, a)), a); }

/// "" if all components are within `absolute` of expected(i).
template <class Expected>
std::string differenceBy(double absolute, const std::vector<float4>& actual, const Expected& expected) {
  std::vector<float> flat;
  for (const float4& v : actual) flat.insert(flat.end(), {v.x, v.y, v.z, v.w});
  return difference(
      flat,
      [&](std::size_t i) {
        const std::array<double, 4> e = expected(i / 4);
        return e[i % 4];
      },
      absolute, 0);
}

}  // namespace

TEST_CASE("geometry") {
  const auto u = values<float4>(kindCount, 1), v = values<float4>(kindCount, 2);
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<float4>({kindCount}), b = device.stream<float4>({kindCount});
    auto c = device.stream<float4>({kindCount}), d = device.stream<float4>({kindCount});
    intrinsics::geometry(streamOf<float4>(device, u), streamOf<float4>(device, v), a, b, c, d);
    // Lengths are up to 16 and dot products up to 256: the bound is a few ulp of these.
    CHECK(differenceBy(1e-4, a.read(), [&](std::size_t i) {
            const Double3 p = of(u[i]), q = of(v[i]);
            const double w = u[i].w, t = v[i].w;
            const Double3 e = sum(p, -1, q);
            return std::array{std::sqrt(dot(p, p) + w * w), std::sqrt(dot(e, e) + (w - t) * (w - t)),
                              dot(p, q) + w * t, std::sqrt(dot(p, p)) + dot(p, q)};
          }) == "");
    CHECK(differenceBy(1e-4, b.read(), [&](std::size_t i) {
            const Double3 p = of(u[i]), q = of(v[i]);
            return std::array{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x,
                              std::fabs(p.x) + p.x * q.x + p.y * q.y};
          }) == "");
    CHECK(differenceBy(1e-5, c.read(), [&](std::size_t i) {
            const Double3 p = of(u[i]), n = normal(of(v[i]));
            const Double3 r = sum(p, -2 * dot(n, p), n);
            return std::array{r.x, r.y, r.z, std::hypot(u[i].y - double{v[i].z}, u[i].z - double{v[i].w})};
          }) == "");
    CHECK(differenceBy(2e-5, d.read(), [&](std::size_t i) {
            const Double3 p = normal(of(u[i])), n = normal(of(v[i]));
            const double eta = 0.75, cosine = dot(n, p), k = 1 - eta * eta * (1 - cosine * cosine);
            const Double3 r = sum(scaled(eta, p), -(eta * cosine + std::sqrt(k)), n);
            return std::array{r.x, r.y, r.z, dot(of(v[i]), of(u[i])) < 0 ? 1.0 : -1.0};
          }) == "");
  });
}

TEST_CASE("scalars may stand among the vectors of an intrinsic") {
  const auto x = values<float4>(kindCount, 1);
  auto s = values<float>(kindCount, 2);
  for (float& v : s) v = std::fabs(v);
  const auto smooth = [](double low, double high, double v) {
    const double t = std::clamp((v - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<float4>({kindCount}), b = device.stream<float4>({kindCount});
    auto c = device.stream<float4>({kindCount}), d = device.stream<float4>({kindCount});
    intrinsics::scalars(streamOf<float4>(device, x), streamOf<float>(device, s), a, b, c, d);
    const auto wzyx = [&](std::size_t i) { return float4{x[i].w, x[i].z, x[i].y, x[i].x}; };
    const auto each = [&](const auto& f, std::size_t i, const float4& other) {
      const float4& v = x[i];
      return std::array<double, 4>{f(v.x, other.x), f(v.y, other.y), f(v.z, other.z), f(v.w, other.w)};
    };
    // mix may be computed as a + t(b - a), with values up to 8 * 8 * 16, of which 1e-3 is 8 ulp.
    CHECK(differenceBy(1e-3, a.read(), [&](std::size_t i) {
            return each(
                [&](double p, double q) {
                  return std::clamp<double>(p, -s[i], s[i]) + (p * (1 - s[i]) + q * s[i]) * 8;
                },
                i, wzyx(i));
          }) == "");
    CHECK(differenceBy(0, b.read(), [&](std::size_t i) {
            return each(
                [&](double p, double q) {
                  return (p < s[i] ? 0 : 1) + 2 * (q < p ? 0 : 1) + 4 * std::max(p, 0.0) +
                         64 * std::min(p, 0.0);
                },
                i, float4{x[i].y, x[i].z, x[i].w, x[i].x});
          }) == "");
    CHECK(differenceBy(1e-5, c.read(), [&](std::size_t i) {
            return each(
                [&](double p, double q) {
                  return smooth(-2, 2, p) + smooth(x[i].x - 1.0, x[i].x + 1.0, x[i].y) +
                         2 * smooth(p - 1, p + 1, q);
                },
                i, wzyx(i));
          }) == "");
    CHECK(differenceBy(1e-5, d.read(), [&](std::size_t i) {
            return each(
                [&](double p, double q) { return (p + 1) / 2 + std::max<double>(p, s[i]) + (p > 0 ? q : p); },
                i, wzyx(i));
          }) == "");
  });
}

TEST_CASE("modf, frexp and sincos give both their parts") {
  std::vector<float4> x = values<float4>(kindCount, 3);
  const float infinity = std::numeric_limits<float>::infinity();
  x[0] = {0, -0.0f, 1, -1};
  x[1] = {3.4e38f, -1.2e-38f, 16777215, -0.5f};
  x[2] = {1.5f, -2.75f, 1024, 1e-30f};
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<float4>({kindCount}), b = device.stream<float4>({kindCount}),
         c = device.stream<float4>({kindCount});
    auto d = device.stream<int4>({kindCount});
    intrinsics::parts(streamOf<float4>(device, x), a, b, c, d);
    CHECK(difference(a.read(), [&](std::size_t i) {
            return by4(
                [](float v) {
                  float whole;
                  return std::modf(v, &whole);
                },
                x[i]);
          }) == "");
    CHECK(difference(b.read(),
                     [&](std::size_t i) { return by4([](float v) { return std::trunc(v); }, x[i]); }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            return by4(
                [](float v) {
                  int e;
                  return std::frexp(v, &e);
                },
                x[i]);
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t i) {
            return by4(
                [](float v) {
                  int e;
                  std::frexp(v, &e);
                  return e;
                },
                x[i]);
          }) == "");

    auto one = device.stream<float4>({1}), two = device.stream<float4>({1}),
         three = device.stream<float4>({1});
    auto four = device.stream<int4>({1});
    intrinsics::parts(streamOf<float4>(device, {{infinity, -infinity, infinity, 1}}), one, two, three, four);
    CHECK(two.read()[0] == float4{infinity, -infinity, infinity, 1});
    CHECK(three.read()[0] == float4{infinity, -infinity, infinity, 0.5f});
  });
}

TEST_CASE("ldexp scales by powers of two to both ends") {
  std::vector<float4> x;
  std::vector<int4> e;
  for (int i = -130; i <= 130; ++i) {
    x.push_back({1, -1.5f, 3, 0.75f});
    e.push_back({i, 1, -i, 2 * i});
  }
  x.push_back({0, 1e-30f, 1e30f, 5});
  e.push_back({100, 200, -200, 1000});
  const auto size = static_cast<std::int64_t>(x.size());
  // A denormal result may be flushed to 0.
  const auto agree = [](float a, float b) {
    return a == b || (std::fabs(b) < 1.1754944e-38f && std::fabs(a) <= std::fabs(b));
  };
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<float4>({size});
    auto b = device.stream<float2>({size});
    auto c = device.stream<float>({size});
    intrinsics::ldexps(streamOf<float4>(device, x), streamOf<int4>(device, e), a, b, c);
    const auto fours = a.read();
    const auto twos = b.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO("exponent " << e[i].x << ", got " << fours[i].x << " " << fours[i].y << " " << fours[i].z << " "
                       << fours[i].w);
      CHECK(agree(fours[i].x, std::ldexp(x[i].x, e[i].x)));
      CHECK(agree(fours[i].y, std::ldexp(x[i].y, e[i].y)));
      CHECK(agree(fours[i].z, std::ldexp(x[i].z, e[i].z)));
      CHECK(agree(fours[i].w, std::ldexp(x[i].w, e[i].w)));
      CHECK(agree(twos[i].x, std::ldexp(x[i].x, e[i].z)));
      CHECK(agree(twos[i].y, std::ldexp(x[i].y, e[i].w)));
    }
    CHECK(difference(c.read(), [&](std::size_t i) { return x[i].x * 8; }) == "");
  });
}

TEST_CASE("bits are moved unchanged, and classes of floats told") {
  const auto x = values<float4>(kindCount, 4);
  auto i = values<int4>(kindCount, 5);
  for (int4& v : i) v = by4([](int b) { return (b & 0x007fffff) | 0x3f800000; }, v);  // floats in [1, 2)
  const float infinity = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float4> special = {{0, 1, -1, 3.4e38f},
                                       {infinity, -infinity, 0, 1},
                                       {nan, 1, infinity, -0.0f},
                                       {1, nan, nan, 2},
                                       {-nan, infinity, 1e-30f, -infinity}};
  onGlAndNative([&](sk::Device& device) {
    const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    auto a = device.stream<int4>({kindCount});
    auto b = device.stream<uint4>({kindCount});
    auto c = device.stream<float4>({kindCount}), d = device.stream<float4>({kindCount});
    intrinsics::bits(streamOf<float4>(device, x), streamOf<int4>(device, i), a, b, c, d);
    CHECK(difference(a.read(), [&](std::size_t k) {
            return by4([&](float v, float w) { return int(bits(v) ^ bits(w)); }, x[k],
                       float4{x[k].w, x[k].z, x[k].y, x[k].x});
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t k) {
            return by4([&](float v) { return bits(v) + bits(x[k].x); }, x[k]);
          }) == "");
    const auto real = [](int v) { return std::bit_cast<float>(v); };
    CHECK(difference(c.read(), [&](std::size_t k) {
            return by4([&](int v, int w) { return real(v) + real(w); }, i[k],
                       int4{i[k].w, i[k].z, i[k].y, i[k].x});
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t k) {
            float4 e = by4([&](int v) { return real(v) - real(i[k].y); }, i[k]);
            e.x = real(i[k].x) - 1;
            e.y = real(0x40490fdb);
            return e;
          }) == "");

    const auto size = static_cast<std::int64_t>(special.size());
    auto isNan = device.stream<bool4>({size}), isInf = device.stream<bool4>({size}),
         isFinite = device.stream<bool4>({size});
    auto mixed = device.stream<int>({size});
    intrinsics::classes(streamOf<float4>(device, special), isNan, isInf, isFinite, mixed);
    CHECK(difference(isNan.read(), [&](std::size_t k) {
            return by4([](float v) { return std::isnan(v); }, special[k]);
          }) == "");
    CHECK(difference(isInf.read(), [&](std::size_t k) {
            return by4([](float v) { return std::isinf(v); }, special[k]);
          }) == "");
    CHECK(difference(isFinite.read(), [&](std::size_t k) {
            return by4([](float v) { return std::isfinite(v); }, special[k]);
          }) == "");
    CHECK(difference(mixed.read(), [&](std::size_t k) {
            const float4& v = special[k];
            return std::isnan(v.x) + 2 * std::isinf(v.y) + 4 * std::isfinite(v.z) +
                   8 * (std::isnan(v.x) || std::isnan(v.y)) + 16 * (std::isfinite(v.z) && std::isfinite(v.w));
          }) == "");
  });
}

TEST_CASE("integers have abs, sign, min, max and clamp") {
  auto x = values<int4>(kindCount, 6), y = values<int4>(kindCount, 7);
  for (auto* list : {&x, &y}) {
    for (int4& v : *list) v = by4([](int k) { return k % 20; }, v);
  }
  const auto u = values<uint4>(kindCount, 8), w = values<uint4>(kindCount, 9);
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<int4>({kindCount}), b = device.stream<int4>({kindCount});
    auto c = device.stream<int4>({kindCount}), d = device.stream<int4>({kindCount});
    intrinsics::ints(streamOf<int4>(device, x), streamOf<int4>(device, y), a, b, c, d);
    const auto sign = [](int v) { return (v > 0) - (v < 0); };
    CHECK(difference(a.read(), [&](std::size_t i) { return by4([](int v) { return std::abs(v); }, x[i]); }) ==
          "");
    CHECK(difference(b.read(), [&](std::size_t i) {
            return by4([&](int p, int q) { return sign(p) + 10 * std::min(p, q) - std::max(q, x[i].x); },
                       x[i], y[i]);
          }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) {
            return by4(
                [](int p, int q) {
                  return std::clamp(p, -5, 7) + std::clamp(q, std::min(p, 0), std::max(p, 0));
                },
                x[i], y[i]);
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t i) {
            return int4{std::abs(x[i].x), sign(y[i].y), std::min(x[i].z, y[i].z), std::clamp(x[i].w, 1, 3)};
          }) == "");
    auto p = device.stream<uint4>({kindCount}), q = device.stream<uint4>({kindCount});
    intrinsics::uints(streamOf<uint4>(device, u), streamOf<uint4>(device, w), p, q);
    CHECK(difference(p.read(), [&](std::size_t i) {
            return by4([](unsigned s,
                          unsigned t) { return std::min(s, t) + std::max(s, 5u) + std::clamp(t, 1u, 9u); },
                       u[i], w[i]);
          }) == "");
    CHECK(difference(q.read(), [&](std::size_t i) {
            return uint4{std::min(u[i].x, 3u), std::max(w[i].y, u[i].y), std::clamp(u[i].z, 2u, 0xfffffff0u),
                         std::max(u[i].w, 1u)};
          }) == "");
  });
}

namespace {

/// Numbers with any number of zeros at either end, and those at the ends of their range.
template <class Number>
std::vector<sk::Vector4<Number>> numbersOfBits(unsigned seed) {
  std::vector<sk::Vector4<Number>> numbers = {
      {0, 1, Number(-1), Number(0x80000000u)}, {Number(0x7fffffff), 2, Number(-2), 0x00ffffff}, {0, 0, 0, 0}};
  for (const uint4& v : values<uint4>(kindCount, seed)) {
    const unsigned k = static_cast<unsigned>(numbers.size());
    numbers.push_back(by4([&](unsigned bits) { return Number(bits << k % 32 >> k / 2 % 32); }, v));
  }
  return numbers;
}

template <class Number, class Kernel, class Wide>
void checkBits(sk::Device& device, const Kernel& kernel, Wide) {
  using Vector = sk::Vector4<Number>;
  const auto x = numbersOfBits<Number>(10), y = numbersOfBits<Number>(11);
  const auto size = static_cast<std::int64_t>(x.size());
  auto a = device.stream<int4>({size}), b = device.stream<int4>({size}), c = device.stream<int4>({size});
  auto d = device.stream<Vector>({size});
  kernel(streamOf<Vector>(device, x), streamOf<Vector>(device, y), a, b, c, d);
  const auto bits = [](Number n) { return static_cast<unsigned>(n); };
  CHECK(difference(a.read(), [&](std::size_t i) {
          return by4([&](Number n) { return std::popcount(bits(n)); }, x[i]);
        }) == "");
  CHECK(difference(b.read(), [&](std::size_t i) {
          return by4([&](Number n) { return std::countl_zero(bits(n)); }, x[i]);
        }) == "");
  CHECK(difference(c.read(), [&](std::size_t i) {
          return by4([&](Number n) { return std::countr_zero(bits(n)); }, x[i]);
        }) == "");
  CHECK(difference(d.read(), [&](std::size_t i) {
          return by4([](Number p, Number q) { return Number(Wide{p} * q >> 32); }, x[i], y[i]);
        }) == "");
}

}  // namespace

// GLSL 4.30 has functions for these, which 3.30 and ES 3.00 lack.
TEST_CASE("bits are counted, and products have an upper half") {
  for (const char* profile : {"native", "glsl330", "glsl430", "essl300"}) {
    INFO(profile);
    sk::Device& one = device(profile);
    checkBits<int>(one, intrinsics::intBits, std::int64_t{});
    checkBits<unsigned>(one, intrinsics::uintBits, std::uint64_t{});

    auto p = one.stream<int4>({2}), q = one.stream<int4>({2});
    auto r = one.stream<uint4>({2});
    intrinsics::mixedBits(streamOf<int>(one, {-1, 1 << 30}), streamOf<unsigned>(one, {3u, 0x80000000u}),
                          streamOf<std::uint8_t>(one, {0, 200}), streamOf<bool>(one, {true, false}), p, q, r);
    CHECK(p.read() == std::vector<int4>{{0, 1, 32, 32}, {3, 0, 24, 3}});
    CHECK(q.read() == std::vector<int4>(2, {8, 32, 32, -1}));
    CHECK(r.read() ==
          std::vector<uint4>{{2, 2, 0xfffffffe, 0}, {1u << 29, 0x7fffffff, 0xfffffffe, 1u << 28}});
  }
}

TEST_CASE("comparisons by name give bool vectors") {
  auto x = values<float3>(kindCount, 1), y = values<float3>(kindCount, 2);
  auto i = values<int3>(kindCount, 3), j = values<int3>(kindCount, 4);
  for (std::size_t k = 0; k < x.size(); k += 3) {
    y[k].y = x[k].y;
    j[k].x = i[k].x;
  }
  onGlAndNative([&](sk::Device& device) {
    auto a = device.stream<bool3>({kindCount}), b = device.stream<bool3>({kindCount}),
         c = device.stream<bool3>({kindCount});
    auto d = device.stream<int4>({kindCount});
    intrinsics::comparisons(streamOf<float3>(device, x), streamOf<float3>(device, y),
                            streamOf<int3>(device, i), streamOf<int3>(device, j), a, b, c, d);
    const auto less = [&](std::size_t k) { return bool3{x[k].x < y[k].x, x[k].y < y[k].y, x[k].z < y[k].z}; };
    CHECK(difference(a.read(), less) == "");
    CHECK(difference(b.read(), [](std::size_t) { return bool3{true, true, true}; }) == "");
    CHECK(difference(c.read(), [&](std::size_t k) {
            return bool3{(x[k].x >= y[k].x) == (i[k].x == j[k].x), (x[k].y >= y[k].y) == (i[k].y == j[k].y),
                         (x[k].z >= y[k].z) == (i[k].z == j[k].z)};
          }) == "");
    CHECK(difference(d.read(), [&](std::size_t k) {
            const bool3 l = less(k);
            const auto below = [](int p, int q) { return unsigned(p) < unsigned(q); };
            return int4{below(i[k].x, j[k].x) || below(i[k].y, j[k].y) || below(i[k].z, j[k].z),
                        x[k].x >= y[k].x && x[k].y >= y[k].y, l.x || l.y || l.z, !l.x && !l.y && !l.z};
          }) == "");
  });
}
