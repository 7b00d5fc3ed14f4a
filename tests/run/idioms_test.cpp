// SPDX-License-Identifier: MIT
//
// idioms.sk against plain C++. Results are exact, because values are small multiples of 1/256; overloads of intrinsics state their
// bound.
#include <algorithm>
#include <cmath>

#include "idioms.sk.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float3, sk::float4, sk::int4;

namespace {

constexpr std::int64_t count = 61;
const std::vector<float> x = values<float>(count);

}  // namespace

TEST_CASE("newer C++ is understood") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float>({count});
    auto s = device.stream<int4>({count});
    idioms::modern(streamOf<float>(device, x), r, s);
    CHECK(difference(r.read(), [](std::size_t i) {
            return (x[i] + 1) + 2 * x[i] + (x[i] + 3.5f) + 6 + (x[i] > 0 ? 1.0f : -1.0f) + 30;
          }) == "");
    CHECK(s.read()[0] == int4{15, 17, 19, 21});
  });
}

TEST_CASE("tables of vectors and structs are constants") {
  std::vector<int> n;
  for (int i = 0; i < 12; ++i) n.push_back(i);
  onGlAndNative([&](sk::Device& device) {
    auto r = device.stream<float3>({12});
    auto s = device.stream<float4>({12});
    idioms::tables(streamOf<int>(device, n), r, s);
    CHECK(difference(r.read(), [](std::size_t i) {
            const float3 palette[] = {{1, 0, 0}, {0, 1, 0}, {0.5f, 0.5f, 0.5f}};
            const float padded[] = {1, 2, 4, 0, 0, 0};
            const float sum = (i % 2 == 0 ? 1.0f : 4.0f) + padded[i % 6];
            const float3 p = palette[i % 3];
            return float3{p.x + sum + 5, p.y + sum + 6, p.z + sum + 1048576};
          }) == "");
    CHECK(difference(s.read(), [](std::size_t i) {
            return float4{9.0f + (i % 3 == 0 ? 100 : 0), 6.0f + (i % 3 == 1 ? 100 : 0),
                          5.0f + (i % 3 == 2 ? 100 : 0), 3};
          }) == "");
  });
}

TEST_CASE("outputs and their members may be passed by reference") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float>({count});
    auto p = device.stream<idioms::Point>({count});
    auto q = device.stream<float4>({count});
    idioms::references(streamOf<float>(device, x), r, p, q);
    CHECK(difference(r.read(), x) == "");
    const auto points = p.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      CHECK(points[i].a == 3);
      CHECK(points[i].v == float3{3, 4, x[i]});
    }
    CHECK(q.read()[5] == float4{4, 4, 4, 4});
  });
}

TEST_CASE("names of GLSL's types and functions, and letters beyond ASCII, are free") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float4>({count});
    idioms::names(streamOf<float>(device, x), r);
    CHECK(difference(r.read(), [](std::size_t i) {
            return float4{x[i] * 2, x[i] - 1, 2 + x[i], (x[i] + 1) / 2};
          }) == "");
    auto area = device.stream<float>({count});
    idioms::maß(streamOf<float>(device, x), area);
    CHECK(difference(area.read(), [](std::size_t i) { return 3.25f * x[i] * x[i]; }) == "");
  });
}

TEST_CASE("intrinsics are overloaded for structs") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float4>({count}), s = device.stream<float4>({count});
    idioms::overloads(streamOf<float>(device, x), r, s);
    const auto isNear = [](float got, double wanted) {
      return std::fabs(got - wanted) <= 1e-4 * (1 + std::fabs(wanted));
    };
    for (std::size_t i = 0; i < r.read().size(); ++i) {
      const double v = std::fabs(double{x[i]}) + 1, a = std::max(v, 2.0), b = std::max(v, 3.0);
      const double da = v < 2 ? 0 : 1, db = v < 3 ? 0 : 1;
      INFO(x[i]);
      CHECK(isNear(r.read()[i].x, std::sin(v * v) + a * b));
      CHECK(isNear(r.read()[i].y, std::cos(v * v) * 2 * v + da * b + a * db));
      CHECK(isNear(r.read()[i].z, std::sqrt(v) + v * v));
      CHECK(isNear(r.read()[i].w, 1 / (2 * std::sqrt(v)) + 2 * v));
      const double u = std::fabs(double{x[i]}), low = std::clamp(double{x[i]}, -0.5, 0.5);
      CHECK(isNear(s.read()[i].x, 0.75 * (std::min(u, 1.0) + std::min(u, 2.0)) + 0.25 * (low - low)));
      CHECK(isNear(s.read()[i].y, std::sqrt(2.0) * u));
      CHECK(s.read()[i].z == 0);
      CHECK(s.read()[i].w == std::floor(x[i]));
    }
  });
}

TEST_CASE("bools in structs keep their components") {
  std::vector<idioms::Flags> flags;
  for (unsigned i = 0; i < 16; ++i)
    flags.push_back({{(i & 1) != 0, (i & 2) != 0, (i & 4) != 0}, {i, 2 * i}, (i & 8) != 0});
  onGlAndNative([&](sk::Device& device) {
    const auto input = streamOf<idioms::Flags>(device, flags);
    auto output = device.stream<idioms::Flags>({16});
    idioms::flags(input, output);
    const auto read = output.read();
    for (std::size_t i = 0; i < flags.size(); ++i) {
      const idioms::Flags& f = flags[i];
      CHECK(read[i].on == sk::bool3{f.on.y, f.on.x, f.on.z});
      CHECK(read[i].any_ == ((f.on.x || f.on.y || f.on.z) && !f.any_));
      CHECK(read[i].count == sk::uint2{f.count.x + f.on.x, f.count.y + f.on.y});
    }
  });
}
