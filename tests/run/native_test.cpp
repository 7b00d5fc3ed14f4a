// SPDX-License-Identifier: MIT
//
// Promises: native code needs no GL; its integers are defined for every operand; its functions are right at
// the extremes; the reference computes in double and takes the same calls.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "native.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using namespace native_code;
using Limits = std::numeric_limits<float>;

constexpr float inf = Limits::infinity();
constexpr float nan = Limits::quiet_NaN();
constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values) {
  auto stream = device.stream<T>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

TEST_CASE("the native device says what it is") {
  sk::Device device = sk::Device::native();
  CHECK(device.name() == "native");
  CHECK(device.profile() == "native");
  CHECK(device.isSoftware());
  CHECK(sk::Device("reference").name() == "reference (native, double)");
  auto stream = device.stream<float>({3});
  CHECK_THROWS_WITH(stream.texture(), Catch::Contains("no textures") && Catch::Contains("read()"));
}

TEST_CASE("quotients by zero and shifts past the width are defined") {
  sk::Device device = sk::Device::native();
  const std::vector<std::int32_t> a{7, -7, least, 1, 5};
  const std::vector<std::int32_t> b{0, 0, -1, 33, -1};
  const std::vector<std::uint32_t> c{7, 9, 1, 2, 3};
  const std::vector<std::uint32_t> d{0, 2, 32, 35, 1};
  auto r = device.stream<sk::int4>({5});
  auto s = device.stream<sk::uint4>({5});
  divisions(streamOf(device, a), streamOf(device, b), streamOf(device, c), streamOf(device, d), r, s);
  CHECK(r.read() == std::vector<sk::int4>{
                        {7, 0, 7, 7}, {-7, 0, -7, -7}, {least, 0, 0, -1}, {0, 1, 2, 0}, {-5, 0, least, 0}});
  CHECK(s.read() ==
        std::vector<sk::uint4>{{7, 0, 7, 7}, {4, 1, 36, 2}, {0, 1, 1, 1}, {0, 2, 16, 0}, {3, 0, 6, 1}});
}

TEST_CASE("what an integer cannot hold becomes the nearest that it can") {
  sk::Device device = sk::Device::native();
  const std::vector<float> x{3e9F, -3e9F, nan, inf, -inf, -1.5F, 4294967040.0F, 5e9F, 2147483648.0F};
  auto i = device.stream<std::int32_t>({9});
  auto u = device.stream<std::uint32_t>({9});
  conversions(streamOf(device, x), i, u);
  CHECK(i.read() == std::vector<std::int32_t>{most, least, 0, most, least, -1, most, most, most});
  CHECK(u.read() == std::vector<std::uint32_t>{3000000000U, 0, 0, 0xffffffffU, 0, 0, 4294967040U, 0xffffffffU,
                                               2147483648U});
}

TEST_CASE("functions at their extremes") {
  sk::Device device = sk::Device::native();
  const std::vector<float> x{nan, 0.0F, -1e-9F, 1e8F, -0.0F, inf};
  const std::vector<float> y{2.5F, 0.0F, 1.0F, 1.0F, 0.0F, -0.0F};
  auto rs = device.stream<sk::float4>({6});
  auto ss = device.stream<sk::float4>({6});
  extremes(streamOf(device, x), streamOf(device, y), rs, ss);
  const auto r = rs.read();
  const auto s = ss.read();
  CHECK(r[0].x == 2.5F);            // minNum and maxNum drop a NaN
  CHECK(r[0].y == 2.5F);
  CHECK(r[1].z == 1.0F);            // pow(0, 0)
  CHECK(r[2].w < 1.0F);             // fract(-1e-9)
  CHECK(s[3].x == 1e8F);            // mix at its ends
  CHECK(s[3].y == 1.0F);
  CHECK(std::signbit(r[4].x));      // min(-0, 0)
  CHECK_FALSE(std::signbit(r[4].y));
  CHECK(r[5].x == 0.0F);
  CHECK(s[5].z == 3.0F);            // clamp(inf, 2, 3)
}

TEST_CASE("lengths neither overflow nor vanish") {
  sk::Device device = sk::Device::native();
  const std::vector<sk::float3> v{{1e30F, 0, 0}, {3e-30F, 4e-30F, 0}, {0, 0, 0}, {inf, 1, 0}, {1, nan, 0}};
  auto ls = device.stream<float>({5});
  auto ns = device.stream<sk::float3>({5});
  lengths(streamOf(device, v), ls, ns);
  const auto l = ls.read();
  const auto n = ns.read();
  CHECK(l[0] == 1e30F);
  CHECK(std::fabs(l[1] - 5e-30F) <= 5e-37F);
  CHECK(l[2] == 0.0F);
  CHECK(l[3] == inf);
  CHECK(std::isnan(l[4]));
  CHECK(n[0] == sk::float3{1, 0, 0});
  CHECK(std::fabs(n[1].x - 0.6F) <= 1e-7F);
  CHECK(n[2] == sk::float3{0, 0, 0});
}

TEST_CASE("the reference computes in double, of the floats that it is given") {
  sk::Device device = sk::Device::reference();
  const std::vector<float> x{0.1F, 3.0F, 1e6F};
  const auto in = streamOf(device, x);
  auto r = device.stream<float>({3});
  cancel(in, r);
  const std::vector<double> exact = r.readReals();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double v = x[i];
    CHECK(exact[i] == (v + double{1e-9F}) - v + v * v * double{1e-12F});
    CHECK(r.read()[i] == static_cast<float>(exact[i]));
  }
  auto twice = device.stream<float>({3});
  cancel(r, twice);   // streams hold doubles between calls
  CHECK(twice.readReals()[0] == (exact[0] + double{1e-9F}) - exact[0] + exact[0] * exact[0] * double{1e-12F});
}

TEST_CASE("sums have the error of a tree, not of a loop") {
  const std::int64_t n = (1 << 20) + 7;
  const std::vector<float> x(static_cast<std::size_t>(n), 0.1F);
  sk::Device device = sk::Device::native();
  sk::Device reference = sk::Device::reference();
  const double exact = 0.1F * static_cast<double>(n);
  const float total = sum(streamOf(device, x));
  // 16 elements one after the other, then pairs: 15 + 17 roundings of half an ulp
  CHECK(std::fabs(total - exact) <= 32 * 0x1p-24 * exact);
  CHECK(sum(streamOf(reference, x)) == static_cast<float>(exact));
}

TEST_CASE("a stream that is read at other places is read as it was") {
  sk::Device device = sk::Device::native();
  auto a = streamOf<float>(device, {1, 2, 3, 4});
  shift(a, 0.5F, a);
  CHECK(a.read() == std::vector<float>{2.5F, 3.5F, 4.5F, 1.5F});
}

TEST_CASE("reals are read of floats alone") {
  sk::Device device = sk::Device::native();
  auto ints = device.stream<std::int32_t>({2});
  CHECK_THROWS_WITH(ints.readReals(), Catch::Contains("int") && Catch::Contains("read()"));
  CHECK(device.stream<sk::float2>({0}).readReals().empty());
  sk::Device& gl = run_tests::device("glsl330");
  CHECK(streamOf<sk::float2>(gl, {{1, 2}, {3, 4}}).readReals() == std::vector<double>{1, 2, 3, 4});
}

}  // namespace
}  // namespace run_tests
