// SPDX-License-Identifier: MIT
//
// Promises: sums of floats keep what their roundings lose, on every profile, unless a call asks for the plain
// tree; what is no sum of floats is folded as ever.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "sums.sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

constexpr double u = 0x1p-24;
constexpr float inf = std::numeric_limits<float>::infinity();

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values) {
  auto stream = device.stream<T>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

/// Numbers of magnitudes from 2^-20 to 2^20 and their negatives, in random order, and a small rest.
std::vector<float> cancelling(std::size_t pairs, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> mantissa(1, 2);
  std::uniform_int_distribution<int> exponent(-20, 20);
  std::vector<float> x;
  for (std::size_t i = 0; i < pairs; ++i) {
    x.push_back(std::ldexp(mantissa(random), exponent(random)));
    x.push_back(-x.back());
  }
  x.push_back(0.125F);
  std::shuffle(x.begin(), x.end(), random);
  return x;
}

double magnitudes(const std::vector<float>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0, [](double s, float v) { return s + std::fabs(v); });
}

/// u for the result's own rounding, and (log2 n)^2 u^2 of the magnitudes: NUMERICS 1.4.
double bound(double exact, double magnitude, std::size_t n) {
  const double log = std::log2(static_cast<double>(n)) + 1;
  return u * std::fabs(exact) + log * log * u * u * magnitude;
}

TEST_CASE("a sum has one rounding, and the square of the others") {
  onEveryLayout([](sk::Device& device) {
    for (const std::size_t pairs : {1U, 500U, 30000U}) {
      const std::vector<float> x = cancelling(pairs, 3);
      const double exact = 0.125;  // all others cancel
      const auto stream = streamOf(device, x);
      INFO(x.size() << " elements");
      CHECK(std::fabs(sums::sum(stream) - exact) <= bound(exact, magnitudes(x), x.size()));
      const auto compensated = sums::sum.with({.accumulate = sk::Accumulate::Compensated});
      CHECK(compensated(stream) == sums::sum(stream));
    }
  });
}

TEST_CASE("the plain tree is there for the asking") {
  onEveryProfile([](sk::Device& device) {
    const std::vector<float> x = cancelling(30000, 4);
    const float plain = sums::sum.with({.accumulate = sk::Accumulate::Tree})(streamOf(device, x));
    CHECK(std::fabs(plain - 0.125) <= 20 * u * magnitudes(x));
    CHECK(std::fabs(plain - 0.125) > bound(0.125, magnitudes(x), x.size()));  // else nothing was to be gained
  });
}

TEST_CASE("one million times 0.1") {
  onEveryProfile([](sk::Device& device) {
    const std::vector<float> x(1 << 20, 0.1F);
    CHECK(sums::sum(streamOf(device, x)) == 0.1F * static_cast<float>(1 << 20));
  });
}

TEST_CASE("vectors, and products of two streams") {
  onEveryProfile([](sk::Device& device) {
    const std::vector<float> a = cancelling(2000, 5);
    const std::vector<float> ones(a.size(), 1.0F);
    CHECK(std::fabs(sums::dot(streamOf(device, a), streamOf(device, ones)) - 0.125) <=
          bound(0.125, magnitudes(a), a.size()));
    std::vector<sk::float3> v;
    for (const float x : a) v.push_back({x, -2 * x, 1});
    const sk::float3 total = sums::sumVectors(streamOf(device, v));
    CHECK(std::fabs(total.x - 0.125) <= bound(0.125, magnitudes(a), a.size()));
    CHECK(std::fabs(total.y + 0.25) <= bound(0.25, 2 * magnitudes(a), a.size()));
    CHECK(total.z == static_cast<float>(a.size()));
  });
}

TEST_CASE("sums beside other accumulators, with an early return") {
  onEveryProfile([](sk::Device& device) {
    std::vector<float> x = cancelling(1000, 6);
    const std::size_t numbers = x.size();
    x.insert(x.begin() + 7, std::numeric_limits<float>::quiet_NaN());
    const auto [s, m, n] = sums::moments(streamOf(device, x), 0.0F);
    x.erase(x.begin() + 7);
    if (n == static_cast<std::int32_t>(x.size())) {  // where the device knows NaN
      CHECK(std::fabs(s - 0.125) <= bound(0.125, magnitudes(x), x.size()));
      CHECK(m == *std::max_element(x.begin(), x.end()));
    }
    CHECK(static_cast<std::size_t>(n) >= numbers);
  });
}

TEST_CASE("sums of rows, into a view of a larger stream") {
  onEveryLayout([](sk::Device& device) {
    constexpr std::int64_t rows = 3;
    constexpr std::int64_t columns = 4001;
    std::vector<float> x;
    for (unsigned r = 0; r < rows; ++r) {
      std::vector<float> row = cancelling(2000, 10 + r);
      x.insert(x.end(), row.begin(), row.end());
    }
    auto a = device.stream<float>({rows, columns});
    a.write(x);
    auto r = device.stream<float>({rows + 2, 2});
    r.write(std::vector<float>(2 * (rows + 2), 7.0F));
    sums::sum(a, r.domain({1, 1}, {rows + 1, 2}));
    const std::vector<float> result = r.read();
    for (std::size_t i = 0; i < rows; ++i) {
      CHECK(std::fabs(result[2 * (i + 1) + 1] - 0.125) <= bound(0.125, magnitudes(x), columns));
      CHECK(result[2 * i] == 7.0F);
    }
  });
}

TEST_CASE("infinities stay, an empty sum is 0") {
  onEveryProfile([](sk::Device& device) {
    CHECK(sums::sum(streamOf<float>(device, {1, inf, 2})) == inf);
    CHECK(sums::sum(streamOf<float>(device, {1, -inf, 2})) == -inf);
    CHECK(sums::sum(streamOf<float>(device, {3e38F, 3e38F})) == inf);
    CHECK(std::isnan(sums::sum(streamOf<float>(device, {inf, -inf}))));
    CHECK(sums::sum(streamOf<float>(device, {})) == 0.0F);
  });
}

TEST_CASE("compensation of what is no sum is refused") {
  sk::Device& device = run_tests::device("glsl330");
  const auto x = streamOf<float>(device, {1, 2});
  CHECK(sums::largest(x) == 2.0F);
  CHECK_THROWS_WITH(sums::largest.with({.accumulate = sk::Accumulate::Compensated})(x),
                    Catch::Contains("largest") && Catch::Contains("no sum of floats"));
}

}  // namespace
}  // namespace run_tests
