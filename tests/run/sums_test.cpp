// SPDX-License-Identifier: MIT
//
// Promises: sums of floats are compensated on every profile, unless a call asks for the plain tree; reduces that are no sums
// of floats are folded as usual.
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

/// Numbers of magnitudes from 2^-20 to 2^20 and their negatives, in random order, and 0.125, which is their sum.
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

/// The error bound of a compensated sum: u |sum| for rounding the result, and (log2 n)^2 u^2 times the sum of magnitudes
/// (Ogita, Rump and Oishi, 2005, for Sum2 over a tree).
double bound(double exact, double magnitude, std::size_t n) {
  const double log = std::log2(static_cast<double>(n)) + 1;
  return u * std::fabs(exact) + log * log * u * u * magnitude;
}

TEST_CASE("a sum has one rounding, and the square of the others") {
  onSomeLayouts([](sk::Device& device) {
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
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(30000, 4);
    const float plain = sums::sum.with({.accumulate = sk::Accumulate::Tree})(streamOf(device, x));
    CHECK(std::fabs(plain - 0.125) <= 20 * u * magnitudes(x));
    CHECK(std::fabs(plain - 0.125) >
          bound(0.125, magnitudes(x), x.size()));  // so these numbers need compensation
  });
}

TEST_CASE("one million times 0.1") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x(1 << 20, 0.1F);
    CHECK(sums::sum(streamOf(device, x)) == 0.1F * static_cast<float>(1 << 20));
  });
}

TEST_CASE("vectors, and products of two streams") {
  onEveryTarget([](sk::Device& device) {
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

TEST_CASE("components by number") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(2000, 8);
    const sk::float2 total =
        sums::indexed.with({.accumulate = sk::Accumulate::Compensated})(streamOf(device, x));
    CHECK(std::fabs(total.x - 0.125) <= bound(0.125, magnitudes(x), x.size()));
    CHECK(std::fabs(total.y - 0.25) <= bound(0.25, 2 * magnitudes(x), x.size()));
  });
}

TEST_CASE("sums beside other accumulators, with an early return") {
  onEveryTarget([](sk::Device& device) {
    std::vector<float> x = cancelling(1000, 6);
    const std::size_t numbers = x.size();
    x.insert(x.begin() + 7, std::numeric_limits<float>::quiet_NaN());
    const auto [s, m, n] = sums::moments(streamOf(device, x), 0.0F);
    x.erase(x.begin() + 7);
    if (n == static_cast<std::int32_t>(x.size())) {  // if isnan() works on the device
      CHECK(std::fabs(s - 0.125) <= bound(0.125, magnitudes(x), x.size()));
      CHECK(m == *std::max_element(x.begin(), x.end()));
    }
    CHECK(static_cast<std::size_t>(n) >= numbers);
  });
}

TEST_CASE("sums of rows, into a view of a larger stream") {
  onSomeLayouts([](sk::Device& device) {
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
  onEveryTarget([](sk::Device& device) {
    CHECK(sums::sum(streamOf<float>(device, {1, inf, 2})) == inf);
    CHECK(sums::sum(streamOf<float>(device, {1, -inf, 2})) == -inf);
    CHECK(sums::sum(streamOf<float>(device, {3e38F, 3e38F})) == inf);
    CHECK(std::isnan(sums::sum(streamOf<float>(device, {inf, -inf}))));
    CHECK(sums::sum(streamOf<float>(device, {})) == 0.0F);
  });
}

TEST_CASE("members of structs, nested ones, beside other members") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(3000, 21);
    const std::size_t n = x.size();
    const std::vector<float> halves(n, 0.5F);
    const auto m = sums::nested(streamOf(device, x), streamOf(device, halves));
    CHECK(m.n == static_cast<std::int32_t>(n));
    CHECK(std::fabs(m.of.s - 0.125) <= bound(0.125, magnitudes(x), n));
    CHECK(std::fabs(m.of.both.x - 0.125) <= bound(0.125, magnitudes(x), n));
    CHECK(std::fabs(m.of.both.y - 0.0625) <= bound(0.0625, magnitudes(x), n));
    CHECK(m.most == *std::max_element(x.begin(), x.end()));
    const auto none = sums::nested(streamOf(device, x), streamOf(device, std::vector<float>(n, -0.5F)));
    CHECK(none.of.s == 0.0F);
    const auto plain = sums::nested.with({.accumulate = sk::Accumulate::Tree});
    CHECK(plain(streamOf(device, x), streamOf(device, halves)).of.s != m.of.s);
    CHECK(sums::nested(streamOf<float>(device, {}), streamOf<float>(device, {})).of.both.y == 0.0F);
  });
}

TEST_CASE("components that are sums, others that are not, and chains in a loop") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(3000, 22);
    const sums::Mixed m = sums::mixed(streamOf(device, x));
    CHECK(std::fabs(m.v.x - 0.125) <= bound(0.125, magnitudes(x), x.size()));
    CHECK(std::fabs(m.v.z + 0.125) <= bound(0.125, magnitudes(x), x.size()));
    CHECK(m.v.y == *std::min_element(x.begin(), x.end()));
    CHECK(m.v.w == *std::max_element(x.begin(), x.end()));
    CHECK(std::fabs(m.s - 0.25) <= bound(0.25, 6 * magnitudes(x), 6 * x.size()));
  });
}

TEST_CASE("a struct that folds itself starts with its first element") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(1000, 23);
    std::vector<sums::Pair> pairs;
    for (const float v : x) pairs.push_back({v, {-0.0F, 2 * v}});
    const sums::Pair m = sums::addPairs(streamOf(device, pairs));
    CHECK(std::fabs(m.s - 0.125) <= bound(0.125, magnitudes(x), x.size()));
    CHECK(std::fabs(m.both.y - 0.25) <= bound(0.25, 2 * magnitudes(x), x.size()));
    CHECK(std::signbit(m.both.x));
    CHECK(m.both.x == 0.0F);
  });
}

TEST_CASE("members of structs in streams, into a view of a larger one") {
  onSomeLayouts([](sk::Device& device) {
    constexpr std::int64_t rows = 3;
    constexpr std::int64_t columns = 1001;
    std::vector<float> x;
    for (unsigned r = 0; r < rows; ++r) {
      const std::vector<float> row = cancelling(500, 30 + r);
      x.insert(x.end(), row.begin(), row.end());
    }
    auto a = device.stream<float>({rows, columns});
    a.write(x);
    auto r = device.stream<sums::Ten>({rows + 2, 2});
    sums::Ten seven{};
    seven.a = 7;
    r.write(std::vector<sums::Ten>(2 * (rows + 2), seven));
    sums::ten(a, r.domain({1, 1}, {rows + 1, 2}));
    const std::vector<sums::Ten> result = r.read();
    for (std::size_t i = 0; i < rows; ++i) {
      const sums::Ten& sum = result[2 * (i + 1) + 1];
      CHECK(std::fabs(sum.a - 0.125) <= bound(0.125, magnitudes(x), columns));
      CHECK(std::fabs(sum.b - 0.25) <= bound(0.25, 2 * magnitudes(x), columns));
      CHECK(std::fabs(sum.i + 0.125) <= bound(0.125, magnitudes(x), columns));
      CHECK(sum.j == columns);
      CHECK(result[2 * i].a == 7.0F);
    }
  });
}

TEST_CASE("sums that a specialisation switches off") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(500, 24);
    const auto stream = streamOf(device, x);
    const sums::Pair one = sums::chosen(stream, sk::none, false);
    CHECK(std::fabs(one.s - 0.125) <= bound(0.125, magnitudes(x), x.size()));
    CHECK(one.both.x == 0.0F);
    const sums::Pair both = sums::chosen(stream, stream, true);
    CHECK(both.s == one.s);
    CHECK(both.both.y == one.s);
  });
}

TEST_CASE("the author's combination, where it adds") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(3000, 25);
    const auto weights = streamOf<float>(device, {1, -0.5F});
    const auto stream = streamOf(device, x);
    const auto least = std::min_element(x.begin(), x.end());
    for (const auto accumulate : {sk::Accumulate::Default, sk::Accumulate::Compensated}) {
      const sums::Spread m = sums::spread.with({.accumulate = accumulate})(stream, weights, 2.0F);
      CHECK(std::fabs(m.sum - 0.25) <= bound(0.25, 2 * magnitudes(x), x.size()));
      CHECK(std::fabs(m.products - 0.0625) <= bound(0.0625, 2 * magnitudes(x), 2 * x.size()));
      CHECK(m.least == *least);
      CHECK(m.at == least - x.begin());
    }
  });
}

TEST_CASE("the author's combination, where it does more") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(3000, 26);
    const sums::Variance v = sums::variance(streamOf(device, x));
    CHECK(v.n == static_cast<float>(x.size()));
    CHECK(std::fabs(v.sum - 0.125) <= bound(0.125, magnitudes(x), x.size()));  // only `sum` is a plain sum
    const auto plain = sums::variance.with({.accumulate = sk::Accumulate::Tree});
    CHECK(plain(streamOf(device, x)).m2 == Approx(v.m2).epsilon(1e-4));
    const auto insisted = sums::scaled.with({.accumulate = sk::Accumulate::Compensated});
    CHECK_THROWS_WITH(insisted(streamOf(device, x)), Catch::Contains("no sum of floats"));
  });
}

TEST_CASE("more planes than a pass reads: plain by default, refused where a call insists") {
  for (const char* profile : {"glsl330", "essl300"}) {
    sk::Device& device = run_tests::device(profile);
    const std::vector<float> x = cancelling(3000, 27);
    const auto stream = streamOf(device, x);
    const auto with = [&](sk::Accumulate accumulate) { return sums::many.with({.accumulate = accumulate}); };
    const bool fits = device.limits().textureUnits >= 34;
    if (!fits) {
      CHECK(sums::many(stream).q == with(sk::Accumulate::Tree)(stream).q);
      CHECK_THROWS_WITH(with(sk::Accumulate::Compensated)(stream),
                        Catch::Contains("many: to combine partial results, 34 planes are read"));
    } else {
      CHECK(std::fabs(sums::many(stream).q - 0.125) <= bound(0.125, magnitudes(x), x.size()));
    }
  }
  const std::vector<float> x = cancelling(3000, 27);
  const sums::Many m = sums::many(streamOf(run_tests::device("native"), x));
  CHECK(std::fabs(m.q - 0.125) <= bound(0.125, magnitudes(x), x.size()));
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
