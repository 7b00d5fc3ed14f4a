// SPDX-License-Identifier: MIT
//
// Uniform arrays, and arrays in uniform structs: every element reaches the kernel, from every kind of host array.
#include "uniforms.sk.hpp"

#include <array>
#include <bit>
#include <cstdint>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

TEST_CASE("uniform arrays") {
  onEveryTarget([](sk::Device& device) {
    auto a = streamOf<float>(device, {4}, {1, 2, 4, 8});
    auto r = device.stream<float>({4});
    uniforms::convolve(std::array<float, 3>{1, 10, 100}, a, r);
    CHECK(r.read() == std::vector<float>{211, 421, 842, 884});
    const float other[3] = {0, 1, 0};
    uniforms::convolve(other, a, r);
    CHECK(r.read() == std::vector<float>{1, 2, 4, 8});
    auto i = streamOf<int>(device, {5}, {0, 1, 2, 3, 4});
    auto table = device.stream<sk::int3>({5});
    auto t = device.stream<float>({5});
    const std::array<sk::int3, 4> rows = {{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {-1, -2, 2147483647}}};
    const std::array<bool, 2> flags = {false, true};
    const std::array<uniforms::Tap, 2> taps = {{{{1, 2}, 3}, {{4, 5}, 6}}};
    uniforms::pick(rows, flags, taps, i, table, t);
    CHECK(table.read() == std::vector<sk::int3>{rows[0], rows[1], rows[2], rows[3], rows[0]});
    CHECK(t.read() == std::vector<float>{2, 6, 2, 6, 2});
  });
}

TEST_CASE("uniform arrays of narrow types") {
  onEveryTarget([](sk::Device& device) {
    auto i = streamOf<int>(device, {-1, 0, 1, 2, 3, 4});
    auto x = streamOf<float>(device, {-1, 0, 1, 2, 3, 4});
    const sk::half w[3] = {0.5f, -2.25f, 1024.0f};
    const std::array<sk::unorm8, 2> u = {0.2f, 1.0f};
    const std::array<sk::snorm16x2, 2> n = {{{1.0f, -1.0f}, {0.0f, 1.0f}}};
    auto r = device.stream<sk::float3>({6});
    uniforms::narrow(w, u, n, x, r);
    const sk::float3 last = {1024, 1, 1};
    CHECK(r.read() ==
          std::vector<sk::float3>{{0.5f, 0.2f, -1}, {0.5f, 0.2f, -1}, {-2.25f, 1, 1}, last, last, last});
    const std::array<sk::short2, 2> s = {{{-32768, 32767}, {5, 6}}};
    const std::array<sk::uchar3, 3> c = {{{1, 2, 255}, {3, 4, 5}, {6, 7, 8}}};
    const std::array<std::int8_t, 5> b = {-128, 1, 2, 3, 127};
    const std::array<bool, 3> on = {false, true, false};
    auto t = device.stream<sk::int4>({6});
    uniforms::narrowIntegers(s, c, b, on, i, t);
    const sk::int4 first = {-32768, 32767, 255, -128};
    CHECK(t.read() ==
          std::vector<sk::int4>{first, first, {-5, -6, -5, -1}, {5, 6, 8, 2}, {5, 6, 8, 3}, {5, 6, 8, 127}});
  });
}

TEST_CASE("uniform arrays of matrices, and of structs with them") {
  onGlAndNative([](sk::Device& device) {
    auto i = streamOf<int>(device, {0, 1});
    const std::array<sk::float3x3, 2> m = {sk::float3x3{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}},
                                           sk::float3x3{{{-1, 0, 0}, {0, -2, 0}, {0, 0, -3}}}};
    const std::array<uniforms::Turn, 2> turns = {
        uniforms::Turn{1.0f, {{{1, 2}, {3, 4}}}, {{1, 2, 3}, {4, 5, 6}}},
        uniforms::Turn{0.5f, {{{0, -1}, {1, 0}}}, {{7, 8, 9}, {-10, -11, -128}}}};
    auto r = device.stream<sk::float3>({2});
    auto t = device.stream<sk::float2>({2});
    auto step = device.stream<sk::int3>({2});
    uniforms::turned(m, turns, i, r, t, step);
    CHECK(r.read() == std::vector<sk::float3>{{321, 654, 987}, {-1, -20, -300}});
    CHECK(t.read() == std::vector<sk::float2>{{21, 43}, {-5, 0.5f}});
    CHECK(step.read() == std::vector<sk::int3>{{4, 5, 6}, {-10, -11, -128}});
  });
}

TEST_CASE("arrays in uniform structs") {
  onGlAndNative([](sk::Device& device) {
    auto i = streamOf<int>(device, {2}, {0, 10});
    auto r = device.stream<float>({2});
    uniforms::Filter filter{{{{1, 0}, 2}, {{3, 0}, 5}, {{7, 0}, 11}}, 3, {true, false, true, false, false}};
    uniforms::filtered(filter, i, r);
    CHECK(r.read() == std::vector<float>{79, 209});
    filter.count = 1;
    uniforms::filtered(filter, i, r);
    CHECK(r.read() == std::vector<float>{2, 22});
  });
}

TEST_CASE("uniforms arrive bit by bit, and again when they change") {
  onEveryTarget([](sk::Device& device) {
    auto k = streamOf<int>(device, {2}, {0, 1});
    auto r = device.stream<sk::int4>({2});
    auto s = device.stream<sk::int4>({2});
    auto t = device.stream<sk::uint4>({2});
    // A NaN with a payload, -0, a denormal and an infinity; then the same with another last value.
    for (const int last : {-8388608, 0x7f7fffff}) {
      const sk::int4 bits = {0x7fc12345, -2147483647 - 1, 1, last};
      const auto f = [](int of) { return std::bit_cast<float>(of); };
      const sk::int4 i = {-2147483647 - 1, 2147483646, 16777217, -1};
      const sk::uint4 u = {4294967295u, 2147483648u, 16777217u, 1u};
      uniforms::bits(sk::float4{f(bits.x), f(bits.y), f(bits.z), f(bits.w)}, i, u, k, r, s, t);
      CHECK(r.read() == std::vector<sk::int4>{bits, bits});
      CHECK(s.read() == std::vector<sk::int4>{i, {-2147483647, 2147483647, 16777218, 0}});
      CHECK(t.read() == std::vector<sk::uint4>{u, u});
    }
  });
}

TEST_CASE("uniforms of one call may be many") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {3}, {0, 1, 2});
    auto r = device.stream<float>({3});
    sk::float4x4 a{}, b{};
    sk::float3x3 c{}, d{};
    a[3].w = 1;
    b[3].w = 10;
    c[2].z = 100;
    d[2].z = 1000;
    uniforms::many(a, b, c, d, 1e4f, sk::float2{0, 1e5f}, 1000000, 2000000u, true, x, r);
    CHECK(r.read() == std::vector<float>{3111111, 3111112, 3111113});
    a[3].w = 2;
    uniforms::many(a, b, c, d, 1e4f, sk::float2{0, 1e5f}, 1000001, 2000000u, false, x, r);
    CHECK(r.read() == std::vector<float>{3111113, 3111113, 3111113});
  });
}
