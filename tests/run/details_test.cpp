// SPDX-License-Identifier: MIT
//
// details.sk against plain C++. All results are exact except constants that intrinsics compute.
#include "details.sk.hpp"

#include <algorithm>
#include <cmath>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using details::Thing;
using sk::bool3, sk::float2, sk::float4, sk::int3;

TEST_CASE("constants may call intrinsics and constexpr functions, and may be tables of structs") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float4>({2});
    auto row = device.stream<details::Row>({2});
    auto n = device.stream<int3>({2});
    details::constants(streamOf<float>(device, {2.0f, 4.0f}), r, row, n);
    const float4 first = r.read()[0];
    CHECK(std::fabs(first.x - 5.0) <= 4e-6);  // square roots and unit vectors have errors of a few ulp
    CHECK(std::fabs(first.y - 2.6) <= 1e-6);
    CHECK(std::fabs(first.z - 2.8) <= 1e-6);
    CHECK(first.w == 0.1f * 4);
    const auto rows = row.read();
    CHECK((rows[0].a == 0.5f && rows[0].b == sk::int2{1, 2} && rows[0].c));
    CHECK((rows[1].a == 1.0f && rows[1].b == sk::int2{3, 3} && !rows[1].c));
    CHECK(n.read()[1] == int3{-3, 4, 0});
  });
}

TEST_CASE("enumerations are uniforms, elements and members") {
  onGlAndNative([](sk::Device& device) {
    constexpr unsigned red = 0, green = 5, blue = 6;
    const auto from = streamOf<unsigned>(device, {green, green, red});
    auto things = device.stream<Thing>({3});
    things.write(std::vector<Thing>{{green, -1}, {blue, 1}, {red, 1}});
    auto other = device.stream<unsigned>({3});
    details::paint(blue, from, things, things, other);
    const auto painted = things.read();
    CHECK((painted[0].colour == blue && painted[1].colour == blue && painted[2].colour == blue));
    CHECK((painted[0].size == -1 && painted[1].size == 1));
    CHECK(other.read() == std::vector<unsigned>{green, blue, blue});
  });
}

TEST_CASE("vectors have the aliases that one gives them") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float4>({1});
    auto c = device.stream<int3>({1});
    details::aliases(streamOf<float2>(device, {{1, 2}}), r, c);
    CHECK(r.read()[0] == float4{1, 2, 2, 1});
    CHECK(c.read()[0] == int3{4, 2, 3});
  });
}

TEST_CASE("bool vectors combine by components") {
  std::vector<bool3> a, b;
  for (unsigned i = 0; i < 64; ++i) {
    a.push_back({(i & 1) != 0, (i & 2) != 0, (i & 4) != 0});
    b.push_back({(i & 8) != 0, (i & 16) != 0, (i & 32) != 0});
  }
  onGlAndNative([&](sk::Device& device) {
    auto r = device.stream<bool3>({64}), s = device.stream<bool3>({64}), t = device.stream<bool3>({64}),
         u = device.stream<bool3>({64});
    details::bits(streamOf<bool3>(device, a), streamOf<bool3>(device, b), r, s, t, u);
    CHECK(difference(r.read(), [&](std::size_t i) {
            return bool3{a[i].x && b[i].x, a[i].y && b[i].y, a[i].z && b[i].z};
          }) == "");
    CHECK(difference(s.read(), [&](std::size_t i) { return bool3{a[i].x || b[i].x, a[i].y, true}; }) == "");
    CHECK(difference(t.read(), [&](std::size_t i) {
            return bool3{a[i].x && !b[i].x, a[i].y && !b[i].y, a[i].z && !b[i].z};
          }) == "");
    CHECK(difference(u.read(), [&](std::size_t i) {
            return bool3{a[i].x || b[i].x, a[i].y || b[i].y, a[i].z || b[i].z};
          }) == "");
  });
}

TEST_CASE("folds by fmin and fmax, and their identities") {
  onGlAndNative([](sk::Device& device) {
    const auto x = values<float>(1021);
    const float least = *std::min_element(x.begin(), x.end());
    CHECK(details::nearest(streamOf<float>(device, x)) == least);
    CHECK(details::nearest(device.stream<float>({0})) == INFINITY);
    const float2 most = details::farthest(streamOf<float2>(device, {{1, -2}, {-3, 4}, {0, 0}}));
    CHECK(most == float2{1, 4});
    CHECK(details::farthest(device.stream<float2>({0})) == float2{-INFINITY, -INFINITY});
  });
}

TEST_CASE("a sum of nothing but -0 keeps its sign where it starts from an element") {
  onGlAndNative([](sk::Device& device) {
    const auto zeros = streamOf<float>(device, std::vector<float>(37, -0.0f));
    CHECK(std::signbit(details::sumOfElements(zeros)));
    CHECK(!std::signbit(details::sumFromZero(zeros)));
  });
}
