// SPDX-License-Identifier: MIT
//
// Compares conversions with the same text compiled as C++. All results are exact: the values are chosen so that no
// operation rounds.
#include "conversions.sk.hpp"

#include "shared/conversions.hpp"
#include "support/shared_cases.hpp"

using namespace run_tests;

namespace {

const std::vector<float> floats = {0.0f,   -0.0f,  0.25f,     -0.25f,   0.5f,      -0.5f,  0.99f,
                                   1.0f,   -1.0f,  1.5f,      -1.5f,    2.5f,      -2.75f, 7.0f,
                                   -7.99f, 100.5f, -4096.25f, 65535.5f, 1048575.5f};

bool isTrue(float x) { return x != 0; }

}  // namespace

TEST_CASE("conversions are those of C++") {
  const Samples<float> floatSamples = pairsOf(floats);
  const Samples<int> intSamples = pairsOf(-20, 21);
#define CHECK_CASE(name) cases.check(#name, conversions::run_##name, conversions::name);
  onGlAndNative([&](sk::Device& device) {
    {
      SharedCases<int, float> cases(device, floatSamples);
      FLOAT_TO_INT_CASES(CHECK_CASE)
    }
    {
      SharedCases<float, int> cases(device, intSamples);
      INT_TO_FLOAT_CASES(CHECK_CASE)
    }
    {
      SharedCases<int, int> cases(device, intSamples);
      INT_TO_INT_CASES(CHECK_CASE)
    }
  });
}

TEST_CASE("integers beyond 2^24 become the nearest float") {
  const std::vector<int> ints = {16777216,   16777217,        16777219, -16777217,
                                 2147483647, -2147483647 - 1, 1 << 30};
  onGlAndNative([&](sk::Device& device) {
    const auto x = streamOf<int>(device, ints);
    const auto zero = streamOf<int>(device, {7}, std::vector<int>(7, 0));
    auto r = device.stream<float>({7});
    conversions::run_toFloat(x, zero, r);
    CHECK(difference(r.read(), [&](std::size_t i) { return static_cast<float>(ints[i]); }) == "");
  });
}

TEST_CASE("vectors are converted by components") {
  std::vector<sk::float4> f;
  std::vector<sk::int4> n;
  for (std::size_t i = 0; i < floats.size(); ++i) {
    f.push_back({floats[i], -floats[i], floats[i] * 2, 1});
    n.push_back(valueAt<sk::int4>(static_cast<std::uint32_t>(i)));
    n.back().y = static_cast<int>(i);
    n.back().z = 0;
  }
  const auto count = static_cast<std::int64_t>(f.size());
  onGlAndNative([&](sk::Device& device) {
    auto toFloat = device.stream<sk::float4>({count});
    auto toInt = device.stream<sk::int4>({count});
    auto toUint = device.stream<sk::uint4>({count});
    auto toBool = device.stream<sk::bool4>({count});
    const auto floatStream = streamOf<sk::float4>(device, f);
    const auto intStream = streamOf<sk::int4>(device, n);
    conversions::vectors(floatStream, intStream, toFloat, toInt, toUint, toBool);
    CHECK(difference(toFloat.read(), [&](std::size_t i) {
            const auto one = [](int v) { return float(v) + float(unsigned(v) & 255u) + float(v != 0); };
            return sk::float4{one(n[i].x), one(n[i].y), one(n[i].z), one(n[i].w)};
          }) == "");
    CHECK(difference(toInt.read(), [&](std::size_t i) {
            const auto one = [](float v) { return int(v) + int(isTrue(v)) * 100; };
            return sk::int4{one(f[i].x), one(f[i].y), one(f[i].z), one(f[i].w)};
          }) == "");
    CHECK(difference(toUint.read(), [&](std::size_t i) {
            const auto one = [](float v, int k) { return unsigned(std::fabs(v)) + unsigned(k); };
            return sk::uint4{one(f[i].x, n[i].x), one(f[i].y, n[i].y), one(f[i].z, n[i].z),
                             one(f[i].w, n[i].w)};
          }) == "");
    CHECK(difference(toBool.read(), [&](std::size_t i) {
            return sk::bool4{int(f[i].x) != 0, int(f[i].y) != 0, isTrue(f[i].z), isTrue(f[i].w)};
          }) == "");

    std::vector<sk::float2> f2;
    std::vector<sk::int2> n2;
    for (std::size_t i = 0; i < f.size(); ++i) {
      f2.push_back({f[i].x, f[i].y});
      n2.push_back({n[i].y, n[i].z});
    }
    auto a = device.stream<sk::float4>({count});
    auto b = device.stream<sk::int3>({count});
    auto c = device.stream<sk::bool2>({count});
    conversions::mixedParts(streamOf<sk::float2>(device, f2), streamOf<sk::int2>(device, n2), a, b, c);
    CHECK(difference(a.read(), [&](std::size_t i) {
            return sk::float4{f2[i].x, f2[i].y, float(n2[i].x), float(n2[i].y)};
          }) == "");
    CHECK(difference(b.read(), [&](std::size_t i) { return sk::int3{int(f2[i].y), n2[i].x > 3, 7}; }) == "");
    CHECK(difference(c.read(), [&](std::size_t i) { return sk::bool2{isTrue(f2[i].x), n2[i].y != 0}; }) ==
          "");
  });
}
#undef CHECK_CASE
