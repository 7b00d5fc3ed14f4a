// SPDX-License-Identifier: MIT
//
// Promises: arithmetic at its extremes gives what docs/language.md says, on every profile and natively. Where GLSL lets devices
// differ, a test states the possible results, and native code gives the one of IEEE 754.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "arithmetic.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

namespace run_tests {
namespace {

using namespace extremes;
using Limits = std::numeric_limits<float>;
using Floats = std::vector<float>;
using Ints = std::vector<std::int32_t>;

constexpr float inf = Limits::infinity();
constexpr float nan = Limits::quiet_NaN();
constexpr float denormal = 1e-40F;
constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
constexpr std::uint32_t all = 0xffffffffU;

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }
bool isNative(const sk::Device& device) { return device.profile() == "native"; }

template <class T>
sk::Stream<T> output(sk::Device& device, std::size_t count) {
  return device.stream<T>({static_cast<std::int64_t>(count)});
}

TEST_CASE("copies, magnitudes and negations keep denormals, zeros and infinities to the bit") {
  const Floats x{1e-45F, 1.17e-38F, -1e-45F, 0.0F, -0.0F, inf, -inf, 1.5F};
  onEveryTarget([&](sk::Device& device) {
    auto same = output<float>(device, x.size());
    auto positive = output<float>(device, x.size());
    auto negative = output<float>(device, x.size());
    copies(streamOf<float>(device, x), same, positive, negative);
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i]);
      CHECK(bits(same.read()[i]) == bits(x[i]));
      CHECK(bits(positive.read()[i]) == (bits(x[i]) & 0x7fffffffU));
      CHECK(bits(negative.read()[i]) == (bits(x[i]) ^ 0x80000000U));
    }
  });
}

TEST_CASE("arithmetic keeps denormals, or takes them as zeros throughout") {
  onEveryTarget([&](sk::Device& device) {
    auto product = output<float>(device, 1);
    auto sum = output<float>(device, 1);
    denormals(streamOf<float>(device, {denormal}), product, sum);
    const bool keeps = sum.read()[0] == denormal + denormal;
    CHECK((keeps || (sum.read()[0] == 0 && !isNative(device))));
    CHECK(product.read()[0] == (keeps ? denormal * 1.0000001F : 0.0F));
  });
}

TEST_CASE("any bits go through a kernel that copies") {
  std::vector<sk::float4> x;
  for (std::uint32_t i = 0; i < 1 << 14; ++i) {
    const auto some = [&](std::uint32_t k) { return std::bit_cast<float>(hashed(4 * i + k + 1)); };
    x.push_back({some(0), some(1), some(2), some(3)});
  }
  x[0] = {std::bit_cast<float>(0x7fc12345U), std::bit_cast<float>(0xff812345U), inf,
          -0.0F};  // the second is a signalling NaN
  onEveryTarget([&](sk::Device& device) {
    auto same = output<sk::float4>(device, x.size());
    copies4(streamOf<sk::float4>(device, x), same);
    const auto got = same.read();
    CHECK(std::memcmp(got.data(), x.data(), x.size() * sizeof(sk::float4)) == 0);
  });
}

TEST_CASE("quotients by zero and differences of infinities are those of IEEE 754") {
  const Floats x{1, -1, 0, inf, inf, -inf}, y{0, 0, 0, inf, 0, 1};
  onEveryTarget([&](sk::Device& device) {
    auto r = output<sk::float4>(device, x.size());
    ieee(streamOf<float>(device, x), streamOf<float>(device, y), r);
    const auto got = r.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i] << ", " << y[i]);
      CHECK(isSame(got[i].x, x[i] / y[i]));
      CHECK(isSame(got[i].y, x[i] - y[i]));
      CHECK(isSame(got[i].z, x[i] * y[i]));
      CHECK(isSame(got[i].w, x[i] + y[i]));
    }
  });
}

// GLSL lets a compiler simplify x * 0 and x - x to 0; native code gives NaN for both.
TEST_CASE("NaN and infinity times a literal zero are NaN, or 0 where the driver folds that") {
  onEveryTarget([&](sk::Device& device) {
    auto product = output<float>(device, 2);
    auto difference = output<float>(device, 2);
    auto test = output<std::int32_t>(device, 2);
    vanishing(streamOf<float>(device, {nan, inf}), product, difference, test);
    for (std::size_t i = 0; i < 2; ++i) {
      const float p = product.read()[i], d = difference.read()[i];
      CHECK((std::isnan(p) || (p == 0 && !isNative(device))));
      CHECK((std::isnan(d) || (d == 0 && !isNative(device))));
      CHECK((test.read()[i] == 1 || (test.read()[i] == 0 && !isNative(device))));
    }
  });
}

TEST_CASE("minima and maxima drop a NaN, and put -0 below 0") {
  const Floats x{nan, -nan, 1, 1, nan, 0.0F, -0.0F, inf, -inf, 2, -inf};
  const Floats y{1, 1, nan, -nan, nan, -0.0F, 0.0F, nan, nan, 1, inf};
  onEveryTarget([&](sk::Device& device) {
    auto r = output<sk::float4>(device, x.size());
    auto s = output<sk::float4>(device, x.size());
    order(streamOf<float>(device, x), streamOf<float>(device, y), r, s);
    const auto got = r.read();
    const auto others = s.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i] << ", " << y[i]);
      const bool areZeros = x[i] == 0 && y[i] == 0;
      const float low = areZeros ? -0.0F : std::fmin(x[i], y[i]);
      const float high = areZeros ? 0.0F : std::fmax(x[i], y[i]);
      CHECK(isSame(got[i].x, low));
      CHECK(isSame(got[i].y, high));
      if (areZeros) CHECK((std::signbit(got[i].x) && !std::signbit(got[i].y)));
      CHECK(isSame(got[i].z, std::fmin(high, 3.0F)));  // clamp(x, y, 3)
      CHECK(got[i].w == std::fmin(std::fmax(x[i], 0.0F), 1.0F));
      CHECK(others[i].x == (x[i] < y[i] ? 0.0F : 1.0F));
      CHECK(others[i].y == (x[i] > 0 ? 1.0F : x[i] < 0 ? -1.0F : 0.0F));
      CHECK(isSame(others[i].z, low));
      CHECK(isSame(others[i].w, high));
    }
    auto lows = output<sk::float3>(device, 1);
    auto highs = output<sk::float3>(device, 1);
    order3(streamOf<sk::float3>(device, {{nan, -1, 5}}), streamOf<float>(device, {2}), lows, highs);
    CHECK(lows.read()[0] == sk::float3{2, -1, 2});
    CHECK(highs.read()[0] == sk::float3{2, 2, 5});
  });
}

TEST_CASE("tests of NaN and infinity ask the bits") {
  onEveryTarget([&](sk::Device& device) {
    auto r = output<sk::int4>(device, 5);
    tests(streamOf<float>(device, {nan, inf, -inf, 0, Limits::max()}), r);
    CHECK(r.read() ==
          std::vector<sk::int4>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0}, {0, 0, 1, 1}});
  });
}

TEST_CASE("mixes are exact at both ends") {
  onEveryTarget([&](sk::Device& device) {
    auto r = output<float>(device, 5);
    mixes(streamOf<float>(device, {1e8F, 1e8F, inf, -3e38F, 1}), streamOf<float>(device, {1, 1, 1, 3e38F, 3}),
          streamOf<float>(device, {1, 0, 0, 1, 0.25F}), r);
    CHECK(r.read() == Floats{1, 1e8F, inf, 3e38F, 1.5F});
  });
}

TEST_CASE("fractions are below 1, halves go to the even neighbour") {
  const Floats x{-1e-9F, 0.75F, -0.25F, nan, inf, 2.5F, 0.5F, 1.0F};
  onEveryTarget([&](sk::Device& device) {
    auto r = output<sk::float4>(device, x.size());
    fractions(streamOf<float>(device, x), 0.0F, 0.0F, r);
    const auto got = r.read();
    CHECK(got[0].x == 0.99999994F);
    CHECK(got[1].x == 0.75F);
    CHECK(got[2].x == 0.75F);
    CHECK(std::isnan(got[3].x));
    CHECK(std::isnan(got[4].x));
    CHECK(got[0].y == 0.0F);
    CHECK(got[1].y == 0.84375F);
    CHECK(got[3].y == 0.0F);  // clamp ignores a NaN
    CHECK(got[4].y == 1.0F);
    CHECK(got[1].z == 1.0F);  // 0.75 / 0 is infinite
    CHECK(got[5].w == 2.0F);
    CHECK(got[6].w == 0.0F);
  });
}

TEST_CASE("lengths neither overflow nor vanish") {
  const std::vector<sk::float3> v{{1e30F, 0, 0}, {3e-30F, 4e-30F, 0}, {0, 0, 0},
                                  {inf, 1, 0},   {1, nan, 0},         {-inf, nan, 0}};
  onEveryTarget([&](sk::Device& device) {
    auto l = output<float>(device, v.size());
    auto d = output<float>(device, v.size());
    auto n = output<sk::float3>(device, v.size());
    lengths(streamOf<sk::float3>(device, v), l, d, n);
    const auto length = l.read();
    const auto unit = n.read();
    CHECK(length[0] == 1e30F);
    CHECK(std::fabs(length[1] - 5e-30F) <= 2 * 0x1p-23F * 5e-30F);
    CHECK(length[2] == 0.0F);
    CHECK(length[3] == inf);
    CHECK(std::isnan(length[4]));
    CHECK(length[5] == inf);  // like hypot
    CHECK(d.read()[0] == 2e30F);
    CHECK(unit[0] == sk::float3{1, 0, 0});
    CHECK(std::fabs(unit[1].x - 0.6F) <= 2 * 0x1p-24F);
    CHECK(unit[2] == sk::float3{0, 0, 0});
  });
}

// Dot products are not scaled: the result is inf - inf, or 0 on a device whose products do not overflow.
TEST_CASE("dot products of 1e30 are NaN, or 0 on GL") {
  onEveryTarget([&](sk::Device& device) {
    auto r = output<float>(device, 2);
    dots(streamOf<sk::float2>(device, {{1e30F, 1e30F}, {3, 4}}),
         streamOf<sk::float2>(device, {{1e30F, -1e30F}, {3, 4}}), r);
    CHECK((std::isnan(r.read()[0]) || (r.read()[0] == 0 && !isNative(device))));
    CHECK(r.read()[1] == 25);
  });
}

TEST_CASE("quotients by zero and shifts past the width") {
  const Ints a{7, -7, least, 1, 5, -9, least}, b{0, 0, -1, 33, -1, 4, 1};
  const std::vector<std::uint32_t> c{7, 9, 1, 2, 3, all, all}, d{0, 2, 32, 35, 1, 10, all};
  onEveryTarget([&](sk::Device& device) {
    auto r = output<sk::int4>(device, a.size());
    auto s = output<sk::uint4>(device, a.size());
    divisions(streamOf<std::int32_t>(device, a), streamOf<std::int32_t>(device, b),
              streamOf<std::uint32_t>(device, c), streamOf<std::uint32_t>(device, d), r, s);
    CHECK(r.read() == std::vector<sk::int4>{{7, 0, 7, 7},
                                            {-7, 0, -7, -7},
                                            {least, 0, 0, -1},
                                            {0, 1, 2, 0},
                                            {-5, 0, least, 0},
                                            {-2, -1, -144, -1},
                                            {least, 0, 0, least / 2}});
    CHECK(s.read() == std::vector<sk::uint4>{{7, 0, 7, 7},
                                             {4, 1, 36, 2},
                                             {0, 1, 1, 1},
                                             {0, 2, 16, 0},
                                             {3, 0, 6, 1},
                                             {429496729, 5, 4294966272U, 4194303},
                                             {1, 0, 0x80000000U, 1}});
    auto q = output<sk::int2>(device, 2);
    auto m = output<sk::int2>(device, 2);
    auto l = output<sk::int2>(device, 2);
    assigned(streamOf<sk::int2>(device, {{7, -7}, {least, 1}}),
             streamOf<sk::int2>(device, {{0, 2}, {-1, 33}}), q, m, l);
    CHECK(q.read() == std::vector<sk::int2>{{7, -3}, {least, 0}});
    CHECK(m.read() == std::vector<sk::int2>{{0, -1}, {0, 1}});
    CHECK(l.read() == std::vector<sk::int2>{{7, -28}, {0, 2}});
    auto x = output<sk::int4>(device, 3);
    auto y = output<sk::uint2>(device, 3);
    literals(streamOf<std::int32_t>(device, {7, -7, least}), streamOf<std::uint32_t>(device, {7, 8, all}), x,
             y);
    CHECK(x.read() == std::vector<sk::int4>{{2, 1, -7, 0}, {-2, -1, 7, -1}, {least / 3, -2, least, -1}});
    CHECK(y.read() == std::vector<sk::uint2>{{2, 0x80000000U}, {2, 0}, {all / 3, 0x80000000U}});
  });
}

TEST_CASE("what an integer cannot hold becomes the nearest that it can, and NaN 0") {
  const Floats x{3e9F,  -3e9F,         nan,  -nan,          inf,           -inf,
                 -1.5F, 4294967040.0F, 5e9F, 2147483648.0F, 2147483520.0F, -0.9F};
  onEveryTarget([&](sk::Device& device) {
    auto i = output<std::int32_t>(device, x.size());
    auto u = output<std::uint32_t>(device, x.size());
    auto v = output<sk::int3>(device, x.size());
    conversions(streamOf<float>(device, x), i, u, v);
    CHECK(i.read() == Ints{most, least, 0, 0, most, least, -1, most, most, most, 2147483520, 0});
    CHECK(u.read() == std::vector<std::uint32_t>{3000000000U, 0, 0, 0, all, 0, 0, 4294967040U, all,
                                                 2147483648U, 2147483520U, 0});
    CHECK(v.read()[0] == sk::int3{most, least, most});
    CHECK(v.read()[2] == sk::int3{0, 0, 0});
    CHECK(v.read()[6] == sk::int3{-1, 1, -3});
  });
}

TEST_CASE("doubles likewise") {
  const double huge = std::numeric_limits<double>::infinity();
  const std::vector<double> x{3e9, -3e9, std::nan(""), huge, -huge, -1.5, -1e-20, 0.75};
  onEveryTarget([&](sk::Device& device) {
    auto i = output<std::int32_t>(device, x.size());
    auto u = output<std::uint32_t>(device, x.size());
    auto low = output<double>(device, x.size());
    auto part = output<double>(device, x.size());
    wide(streamOf<double>(device, x), i, u, low, part);
    CHECK(i.read() == Ints{most, least, 0, most, least, -1, 0, 0});
    CHECK(u.read() == std::vector<std::uint32_t>{3000000000U, 0, 0, all, 0, 0, 0, 0});
    CHECK(low.read() == std::vector<double>{2, -3e9, 2, 2, -huge, -1.5, x[6] < 0 ? low.read()[6] : 0, 0.75});
    CHECK(part.read()[6] < 1);
    CHECK(part.read()[7] == 0.75);
  });
}

TEST_CASE("an index outside a vector is the nearest component") {
  onEveryTarget([&](sk::Device& device) {
    auto r = output<float>(device, 4);
    auto w = output<sk::float4>(device, 4);
    const std::vector<sk::float4> v(4, {1, 2, 3, 4});
    components(streamOf<sk::float4>(device, v), streamOf<std::int32_t>(device, {-1, 4, most, 2}), r, w);
    CHECK(r.read() == Floats{1, 4, 4, 3});
    CHECK(w.read() == std::vector<sk::float4>{{-1, 2, 3, 4}, {1, 2, 3, -1}, {1, 2, 3, -1}, {1, 2, -1, 4}});
  });
}

TEST_CASE("an index outside a gather is the nearest element or the border, and NaN is some index") {
  onEveryTarget([&](sk::Device& device) {
    const auto a = streamOf<float>(device, {5, 6, 7});
    auto r = output<float>(device, 5);
    const auto i = streamOf<std::int32_t>(device, {-1, 3, least, most, 1});
    fetch(a, i, r);
    CHECK(r.read() == Floats{5, 7, 5, 7, 6});
    fetchBorder(a, i, r);
    CHECK(r.read() == Floats{-7, -7, -7, -7, 6});
    fetchAt(a, streamOf<float>(device, {nan, inf, -inf, 3e38F, 0.6F}), r);
    CHECK(r.read() == Floats{5, 7, 5, 7, 6});
  });
}

TEST_CASE("a gather reads beside NaN exactly, and so does a sample without weight there") {
  onEveryTarget([&](sk::Device& device) {
    const auto a = streamOf<float>(device, {1, nan, 3, 4});
    auto r = output<float>(device, 3);
    fetch(a, streamOf<std::int32_t>(device, {0, 2, 3}), r);
    CHECK(r.read() == Floats{1, 3, 4});
    lerped(a, streamOf<float>(device, {0, 3, 2.5F}), r);
    CHECK(r.read() == Floats{1, 4, 3.5F});
  });
}

TEST_CASE("every length: none, one, primes, and past what a float counts") {
  onEveryTarget([&](sk::Device& device) {
    for (const std::int64_t n : {0, 1, 2, 1021, 4093, 65537}) {
      INFO(n);
      auto r = device.stream<std::int32_t>({n});
      indices(r);
      CHECK(static_cast<std::int64_t>(r.read().size()) == n);
      CHECK(sum(r) == static_cast<std::int32_t>(n * (n - 1) / 2));
      CHECK(misplaced(r) == 0);
    }
    CHECK(largest(device.stream<float>({0})) == -inf);
    if (isNative(device)) return;  // native code computes indices without floats
    const std::int64_t n = (1 << 24) + 1;
    auto r = device.stream<std::int32_t>({n});
    indices(r);
    CHECK(misplaced(r) == 0);
    CHECK(r.domain({n - 2}, {n}).read() == Ints{(1 << 24) - 1, 1 << 24});
  });
}

TEST_CASE("a stream that no device can hold is refused by its size") {
  onEveryTarget([&](sk::Device& device) {
    CHECK_THROWS_AS(device.stream<sk::float4>({std::int64_t{1} << 24, std::int64_t{1} << 24}), sk::Error);
  });
}

TEST_CASE("a stream that is read and written is read as it was") {
  onEveryTarget([&](sk::Device& device) {
    auto a = streamOf<float>(device, {1, 2, 3, 4});
    shifted(a, a);
    CHECK(a.read() == Floats{2, 3, 4, 4});
  });
}

TEST_CASE("constants and computed values agree, but that a device may take denormals as 0") {
  onEveryTarget([&](sk::Device& device) {
    auto constant = output<float>(device, 1);
    auto computed = output<float>(device, 1);
    folded(streamOf<float>(device, {1e-20F}), constant, computed);
    const float exact = 1e-20F * 1e-20F;
    for (const float got : {constant.read()[0], computed.read()[0]}) {
      CHECK((got == exact || (got == 0 && !isNative(device))));
    }
  });
}

TEST_CASE("eight outputs of eight types") {
  onEveryTarget([&](sk::Device& device) {
    auto a = output<float>(device, 2);
    auto b = output<sk::float2>(device, 2);
    auto c = output<sk::float4>(device, 2);
    auto d = output<std::int32_t>(device, 2);
    auto e = output<sk::uint4>(device, 2);
    auto f = output<sk::half>(device, 2);
    auto g = output<sk::unorm8>(device, 2);
    auto h = output<std::int16_t>(device, 2);
    eight(streamOf<std::int32_t>(device, {7, -3}), a, b, c, d, e, f, g, h);
    CHECK(a.read() == Floats{7, -3});
    CHECK(b.read() == std::vector<sk::float2>{{7, -7}, {-3, 3}});
    CHECK(c.read()[1] == sk::float4{-3, -3, -3, -3});
    CHECK(d.read() == Ints{7, -3});
    CHECK(e.read()[1].w == all - 2);
    CHECK(static_cast<float>(f.read()[1]) == -3);
    CHECK(static_cast<float>(g.read()[0]) == 1);
    CHECK(h.read() == std::vector<std::int16_t>{7, -3});
  });
}

}  // namespace
}  // namespace run_tests
