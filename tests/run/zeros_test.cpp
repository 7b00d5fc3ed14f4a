// SPDX-License-Identifier: MIT
//
// Promises: where a function is zero, the zero has the sign that C99's annex F gives it, in each precision and on every
// device; and a remainder that is denormal is exact, whatever the device's arithmetic makes of such numbers.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"
#include "zeros.sk.hpp"

namespace run_tests {
namespace {

using sk::Precision;

constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();

struct Pair {
  float x, y;
};

std::vector<Pair> pairs() {
  std::vector<Pair> list;
  const float values[] = {0, -0.0F, 0.25F, -0.25F, 1, -1, 1.5F, -1.5F, 2.5F, inf, -inf, nan};
  for (const float x : values) {
    for (const float y : values) list.push_back({x, y});
  }
  return list;
}

float sign(float x) { return x > 0 ? 1.0F : x < 0 ? -1.0F : 0.0F; }
float saturated(float x) { return x > 0 ? std::fmin(x, 1.0F) : 0.0F; }
/// IEEE 754's minNum and maxNum, with -0 below 0.
float least(float x, float y) { return x == y ? (std::signbit(x) ? x : y) : std::fmin(x, y); }
float most(float x, float y) { return x == y ? (std::signbit(x) ? y : x) : std::fmax(x, y); }
float modulus(float x, float y) {
  const float r = std::fmod(x, y);
  return r != 0 && (r < 0) != (y < 0) ? r + y : r;
}
float fraction(float x) {
  float whole = 0;
  return std::modf(x, &whole);
}
float whole(float x) {
  float part = 0;
  std::modf(x, &part);
  return part;
}

/// The same class, and near the same value.
bool agree(float got, float wanted) {
  if (std::isnan(wanted)) return std::isnan(got);
  if (std::signbit(got) != std::signbit(wanted)) return false;
  if (wanted == 0 || std::isinf(wanted)) return got == wanted;
  return std::fabs(got - wanted) <= 1e-3F * std::fabs(wanted);
}

void compare(const char* what, const std::vector<sk::float4>& got, const std::vector<Pair>& given,
             sk::float4 (*wanted)(float x, float y)) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto [x, y] = given[i];
    const sk::float4 right = wanted(x, y);
    INFO(what << " of " << x << " and " << y << ": " << got[i].x << " " << got[i].y << " " << got[i].z << " "
              << got[i].w << ", not " << right.x << " " << right.y << " " << right.z << " " << right.w);
    const bool isRight = agree(got[i].x, right.x) && agree(got[i].y, right.y) && agree(got[i].z, right.z) &&
                         agree(got[i].w, right.w);
    CHECK(isRight);
  }
}

void checkZeros(sk::Device& device, Precision precision) {
  const std::vector<Pair> given = pairs();
  const auto count = std::ssize(given);
  std::vector<float> first, second;
  for (const Pair& pair : given) {
    first.push_back(pair.x);
    second.push_back(pair.y);
  }
  const auto x = streamOf(device, first), y = streamOf(device, second);
  auto a = device.stream<sk::float4>({count}), b = device.stream<sk::float4>({count}),
       c = device.stream<sk::float4>({count}), d = device.stream<sk::float4>({count});
  zeros::steps.with({.precision = precision})(x, y, a, b, c, d);
  compare("floor, ceil, trunc, round", a.read(), given, [](float p, float) -> sk::float4 {
    return {std::floor(p), std::ceil(p), std::trunc(p), std::nearbyint(p)};
  });
  compare("fract, sign, sqrt, -", b.read(), given,
          [](float p, float) -> sk::float4 { return {p - std::floor(p), sign(p), std::sqrt(p), -p}; });
  compare("min, max, mix", c.read(), given,
          [](float p, float q) -> sk::float4 { return {least(p, q), most(p, q), p, q}; });
  compare("fmod, mod, +, *", d.read(), given,
          [](float p, float q) -> sk::float4 { return {std::fmod(p, q), modulus(p, q), p + q, p * q}; });
  zeros::others.with({.precision = precision})(x, y, a, b, c);
  compare("ldexp, modf, saturate", a.read(), given, [](float p, float) -> sk::float4 {
    return {std::ldexp(p, -3), fraction(p), whole(p), saturated(p)};
  });
  compare("clamp, step, normalize, fma", b.read(), given, [](float p, float q) -> sk::float4 {
    const float direction = p == 0 ? p : p / std::fabs(p);
    return {least(most(p, -0.0F), 0.0F), p < q ? 0.0F : 1.0F, direction, p * q + -0.0F};
  });
  compare("radians, -, /, abs", c.read(), given,
          [](float p, float q) -> sk::float4 { return {p * 0.0174532925F, p - q, p / q, std::fabs(p)}; });
}

TEST_CASE("zeros have the signs of annex F") {
  onEveryTarget([](sk::Device& device) {
    for (const Precision precision : {Precision::Single, Precision::Half, Precision::Extended}) {
      INFO("precision " << static_cast<int>(precision));
      checkZeros(device, precision);
    }
  });
  sk::Device& doubles = device("glsl330");
  INFO("glsl330, in doubles");
  checkZeros(doubles, Precision::Double);
  sk::Device reference = sk::Device::reference();
  INFO("reference");
  checkZeros(reference, Precision::Default);
}

TEST_CASE("remainders below the smallest normal float are exact") {
  std::vector<float> x, y;
  std::mt19937 random(11);
  for (int i = 0; i < 4096; ++i) {
    // normal arguments of either sign, up to 2^-95 and 2^-100
    const auto number = [&](std::uint32_t exponents) {
      const auto exponent = 1 + static_cast<std::uint32_t>(random()) % exponents;
      return std::bit_cast<float>((exponent << 23) | (static_cast<std::uint32_t>(random()) & 0x807fffffU));
    };
    x.push_back(number(31));
    y.push_back(number(26));
  }
  onEveryTarget([&](sk::Device& device) {
    auto r = device.stream<float>({std::ssize(x)}), s = device.stream<float>({std::ssize(x)});
    zeros::remainders(streamOf(device, x), streamOf(device, y), r, s);
    const std::vector<float> rests = r.read(), moduli = s.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool isRight = rests[i] == std::fmod(x[i], y[i]) && moduli[i] == modulus(x[i], y[i]);
      INFO(x[i] << " by " << y[i] << ": " << rests[i] << ", " << moduli[i]);
      CHECK(isRight);
    }
  });
}

}  // namespace
}  // namespace run_tests
