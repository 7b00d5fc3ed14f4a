// SPDX-License-Identifier: MIT
//
// Promises: Accumulate::Exact adds the unrounded products of floats and rounds once; Accumulate::Compensated is within
// u + 400 u^2 cond of the sum of products (Dot2 of Ogita, Rump and Oishi, SIAM J. Sci. Comput. 26, 2005, over a tree) if no
// rounding error of a product is below 2^-126.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "dots.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/oracle.hpp"
#include "support/streams.hpp"

namespace numerics {
namespace {

using run_tests::onEveryTarget;
using run_tests::streamOf;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr double u = 0x1p-24;
constexpr sk::CallOptions compensated{.accumulate = sk::Accumulate::Compensated};
constexpr sk::CallOptions exact{.accumulate = sk::Accumulate::Exact};

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

float exactDot(sk::Device& device, const std::vector<float>& x, const std::vector<float>& y) {
  return dots::dot.with(exact)(streamOf(device, x), streamOf(device, y));
}

void addAll(TrueSum& sum, const std::vector<float>& x, const std::vector<float>& y) {
  for (std::size_t i = 0; i < x.size(); ++i) sum.addProduct(x[i], y[i]);
}

TEST_CASE("ill-conditioned dot products, exact to the bit") {
  for (const double wanted : {1e6, 1e10, 1e14, 1e20, 1e24}) {
    const Pairs pairs = illConditionedDot(4001, wanted, 7);
    TrueSum sum;
    addAll(sum, pairs.x, pairs.y);
    INFO("condition " << sum.condition());
    CHECK(sum.condition() > wanted / 100);
    onEveryTarget([&](sk::Device& device) {
      const auto x = streamOf(device, pairs.x);
      const auto y = streamOf(device, pairs.y);
      CHECK(bits(dots::dot.with(exact)(x, y)) == bits(sum.rounded()));
      CHECK(sum.errorOf(dots::dot.with(compensated)(x, y)) <=
            (u + 400 * u * u * sum.condition()) * std::fabs(sum.value()));
    });
  }
}

TEST_CASE("any floats at all, whose products overflow and underflow") {
  for (const std::size_t n : {1U, 2U, 32U, 33U, 1021U, 20011U}) {
    const std::vector<float> x = anyFloats(n, static_cast<unsigned>(n));
    const std::vector<float> y = anyFloats(n, static_cast<unsigned>(n) + 1);
    TrueSum sum;
    addAll(sum, x, y);
    onEveryTarget([&](sk::Device& device) {
      INFO(n << " elements");
      CHECK(bits(exactDot(device, x, y)) == bits(sum.rounded()));
    });
  }
  onEveryTarget([](sk::Device& device) {
    CHECK(exactDot(device, {1e38F, 1e38F, 2}, {1e38F, -1e38F, 3}) == 6.0F);
    const std::vector<float> tiny(1 << 12, 0x1p-75F);  // each square is 2^-150, half the smallest denormal
    CHECK(dots::squares.with(exact)(streamOf(device, tiny)) == 0x1p-138F);
  });
}

TEST_CASE("dot products on the reference round no product of doubles") {
  sk::Device device = sk::Device::reference();
  for (const double wanted : {1e10, 1e24}) {
    const Pairs pairs = illConditionedDot(4001, wanted, 7);
    TrueSum sum;
    addAll(sum, pairs.x, pairs.y);
    CHECK(bits(exactDot(device, pairs.x, pairs.y)) == bits(sum.rounded()));
  }
  // (1 + a)(1 - a) - 1 = -a^2, which a rounded product of doubles loses completely
  auto x = device.stream<float>({2}), y = device.stream<float>({2});
  x.writeReals(std::vector<double>{1 + 0x1p-40, -1});
  y.writeReals(std::vector<double>{1 - 0x1p-40, 1});
  auto result = device.stream<float>({1});
  dots::dot.with(exact)(x, y, result);
  CHECK(result.readReals()[0] == -0x1p-80);
}

TEST_CASE("vectors' dot products, products by component, differences of products") {
  const Pairs a = illConditionedDot(3001, 1e16, 8);
  std::vector<sk::float3> x;
  std::vector<sk::float3> y;
  std::vector<sk::float2> v;
  std::vector<sk::float4> m;
  TrueSum dot;
  TrueSum first;
  TrueSum second;
  TrueSum difference;
  for (std::size_t i = 0; i < a.x.size(); ++i) {
    x.push_back({a.x[i], 1.1F, a.y[i]});
    y.push_back({a.y[i], 0.3F, 1e-7F});
    v.push_back({a.x[i], -3.3F});
    m.push_back({a.x[i], 1.7F, 2.3F, a.y[i]});
    dot.addProduct(a.x[i], a.y[i]);
    dot.addProduct(1.1F, 0.3F);
    dot.addProduct(a.y[i], 1e-7F);
    first.addProduct(a.x[i], a.y[i]);
    second.addProduct(-3.3F, a.y[i]);
    difference.addProduct(a.x[i], a.y[i]);
    difference.addProduct(-1.7F, 2.3F);
  }
  const auto withinBound = [](const TrueSum& sum, float result) {
    return sum.errorOf(result) <= (u + 400 * u * u * sum.condition()) * std::fabs(sum.value());
  };
  onEveryTarget([&](sk::Device& device) {
    const auto c = dots::componentwise.with(compensated)(streamOf(device, v), streamOf(device, a.y));
    CHECK(withinBound(first, c.x));
    CHECK(withinBound(second, c.y));
    CHECK(withinBound(dot, dots::dotVectors(streamOf(device, x), streamOf(device, y))));
    CHECK(withinBound(difference, dots::crossed(streamOf(device, m))));
    CHECK(bits(dots::dotVectors.with(exact)(streamOf(device, x), streamOf(device, y))) ==
          bits(dot.rounded()));
    const sk::float2 both = dots::componentwise.with(exact)(streamOf(device, v), streamOf(device, a.y));
    CHECK(bits(both.x) == bits(first.rounded()));
    CHECK(bits(both.y) == bits(second.rounded()));
    CHECK(bits(dots::crossed.with(exact)(streamOf(device, m))) == bits(difference.rounded()));
  });
}

TEST_CASE("products that are chosen, put into vectors and added in one call") {
  for (const double wanted : {1e6, 1e12}) {
    const Pairs pairs = illConditionedDot(2001, wanted, 10);
    TrueSum dot;
    TrueSum more;
    addAll(dot, pairs.x, pairs.y);
    addAll(more, pairs.x, pairs.y);
    for (std::size_t i = 0; i < pairs.x.size(); ++i) more.add(1);
    const auto withinBound = [](const TrueSum& sum, float result) {
      return sum.errorOf(result) <= (u + 400 * u * u * sum.condition()) * std::fabs(sum.value());
    };
    onEveryTarget([&](sk::Device& device) {
      const auto x = streamOf(device, pairs.x);
      const auto y = streamOf(device, pairs.y);
      const sk::float3 sum = dots::chosen.with(compensated)(x, y);
      CHECK(withinBound(dot, -sum.x));
      CHECK(sum.y == 2001.0F);
      CHECK(withinBound(more, -sum.z));
      const sk::float3 rounded = dots::chosen.with(exact)(x, y);
      CHECK(bits(-rounded.x) == bits(dot.rounded()));
      CHECK(bits(-rounded.z) == bits(more.rounded()));
    });
  }
}

TEST_CASE("products in members, in a loop over a gather, beside others that the author combines") {
  for (const double wanted : {1e6, 1e10, 1e14}) {
    const Pairs pairs = illConditionedDot(3001, wanted, 9);
    const std::vector<float> table = {1.1F, -0x1.234568p20F};
    TrueSum dot;
    TrueSum differences;
    addAll(dot, pairs.x, pairs.y);
    for (std::size_t i = 0; i < pairs.x.size(); ++i) {
      for (const float t : table)
        differences.addProduct(pairs.x[i], t), differences.addProduct(-pairs.y[i], t);
    }
    const auto withinBound = [](const TrueSum& sum, float result) {
      return sum.errorOf(result) <= (u + 400 * u * u * sum.condition()) * std::fabs(sum.value());
    };
    onEveryTarget([&](sk::Device& device) {
      const dots::Products p = dots::members.with(compensated)(
          streamOf(device, pairs.x), streamOf(device, pairs.y), streamOf(device, table));
      CHECK(withinBound(dot, p.dots.x));
      CHECK(withinBound(differences, p.dots.y));
      CHECK(p.least == *std::min_element(pairs.x.begin(), pairs.x.end()));
    });
  }
}

TEST_CASE("products of expressions beside terms that are none, in members, under a condition") {
  const Pairs pairs = illConditionedDot(3001, 1e10, 11);
  TrueSum all, positive;
  for (std::size_t i = 0; i < pairs.x.size(); ++i) {
    const float x = pairs.x[i];
    const float y = pairs.y[i];
    all.addProduct(x, y + 1);  // y + 1 is rounded, the product is not
    all.add(-y);
    if (x > 0) positive.addProduct(x - 1, y);
  }
  onEveryTarget([&](sk::Device& device) {
    const dots::Parts p = dots::parts.with(exact)(streamOf(device, pairs.x), streamOf(device, pairs.y));
    CHECK(bits(p.all) == bits(all.rounded()));
    CHECK(bits(p.positive) == bits(positive.rounded()));
  });
}

TEST_CASE("compensated products at the ends of the range") {
  onEveryTarget([](sk::Device& device) {
    const auto dot = [&](const std::vector<float>& x, const std::vector<float>& y) {
      return dots::dot.with(compensated)(streamOf(device, x), streamOf(device, y));
    };
    CHECK(dot({3e38F, 1}, {2, 1}) == inf);
    CHECK(dot({inf, 1}, {2, 1}) == inf);
    CHECK(std::isnan(dot({inf, 1}, {0, 1})));
    CHECK(dot({0x1.fffffep127F, 0x1p-3F}, {1, 1}) ==
          0x1.fffffep127F);  // splitting it with the factor 4097 would overflow
    CHECK(dot({0x1p-70F, 1}, {0x1p-70F, 1}) == 1.0F);
    CHECK(std::fabs(dot({0x1.234568p-60F}, {0x1.fedcbap-60F})) <= 0x1p-118F);
  });
}

TEST_CASE("what products of numbers of any size are rounded by") {
  std::mt19937 random(7);
  const auto number = [&](int power) {
    const float sign = random() % 2 == 0 ? 1.0F : -1.0F;
    return sign * std::ldexp(1 + static_cast<float>(random() % (1U << 23U)) * 0x1p-23F, power);
  };
  struct Product {
    float x, y, rounded, error;
  };
  std::vector<Product> products{{-0x1.07654p+127F, 0x1.8a9f2p-118F, 0, 0},
                                {0x1.69ce0cp-114F, 0x1.000002p28F, 0, 0}};
  for (int power = -126; power <= 127; ++power) {
    for (int sum = -76; sum < 126; sum += 11) {
      if (sum - power >= -126 && sum - power <= 127)
        products.push_back({number(power), number(sum - power), 0, 0});
    }
  }
  for (Product& one : products) {
    const double product = static_cast<double>(one.x) * one.y;
    one.rounded = static_cast<float>(product);
    one.error = static_cast<float>(product - one.rounded);
  }
  // Each product, and what it is rounded to taken away, in a row of its own.
  std::vector<float> x, y;
  std::vector<std::int32_t> starts{0};
  for (const Product& one : products) {
    x.insert(x.end(), {one.x, -one.rounded});
    y.insert(y.end(), {one.y, 1});
    starts.push_back(static_cast<std::int32_t>(x.size()));
  }
  onEveryTarget([&](sk::Device& device) {
    const sk::Rows rows(streamOf(device, starts));
    const auto left = streamOf(device, x), right = streamOf(device, y);
    for (const sk::CallOptions& options :
         {compensated, sk::CallOptions{.accumulate = sk::Accumulate::Extended},
          sk::CallOptions{.precision = sk::Precision::Extended}}) {
      auto sums = device.stream<float>({static_cast<std::int64_t>(products.size())});
      dots::dot.with(options)(rows(left), rows(right), sums);
      const std::vector<float> got = sums.read();
      for (std::size_t i = 0; i < products.size(); ++i) {
        INFO(std::hexfloat << products[i].x << " times " << products[i].y);
        CHECK(got[i] == products[i].error);
      }
    }
  });
}

TEST_CASE("products of infinities, zeros and NaN") {
  onEveryTarget([](sk::Device& device) {
    CHECK(exactDot(device, {inf, 1}, {2, 3}) == inf);
    CHECK(exactDot(device, {inf, 1}, {-2, 3}) == -inf);
    CHECK(bits(exactDot(device, {inf, 1}, {0, 3})) == 0x7fc00000U);
    CHECK(bits(exactDot(device, {inf, inf}, {1, -1})) == 0x7fc00000U);
    CHECK(bits(exactDot(device, {std::numeric_limits<float>::quiet_NaN()}, {0})) == 0x7fc00000U);
    CHECK(bits(exactDot(device, {-1}, {0})) == 0);  // folds from 0, like the plain sum
    CHECK(bits(exactDot(device, {}, {})) == 0);
  });
}

}  // namespace
}  // namespace numerics
