// SPDX-License-Identifier: MIT
//
// Promises: Accumulate::Exact gives the sum rounded once, the same bits in every order, shape and on every profile;
// Accumulate::Compensated keeps the bound of docs/accuracy.md, and is in fact within u + 400 u^2 cond of the sum
// (Ogita, Rump and Oishi, SIAM J. Sci. Comput. 26, 2005). (carries_test.cpp has more.)
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "sums.sk.hpp"
#include "support/devices.hpp"
#include "support/oracle.hpp"
#include "support/streams.hpp"

namespace numerics {
namespace {

using run_tests::onEveryTarget;
using run_tests::streamOf;

constexpr double u = 0x1p-24;
constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float denormal = std::numeric_limits<float>::denorm_min();
constexpr sk::CallOptions exact{.accumulate = sk::Accumulate::Exact};
constexpr sk::CallOptions compensated{.accumulate = sk::Accumulate::Compensated};
constexpr sk::CallOptions tree{.accumulate = sk::Accumulate::Tree};

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

float exactSum(sk::Device& device, const std::vector<float>& x) {
  return sums::sum.with(exact)(streamOf(device, x));
}

float trueSum(const std::vector<float>& x) {
  TrueSum sum;
  for (const float v : x) sum.add(v);
  return sum.rounded();
}

TEST_CASE("ill-conditioned sums: exact to the bit, compensated within its bound") {
  for (const double wanted : {1e6, 1e10, 1e14, 1e20, 1e24}) {
    const std::vector<float> x = illConditionedSum(4001, wanted, 7);
    TrueSum sum;
    for (const float v : x) sum.add(v);
    INFO("condition " << sum.condition());
    CHECK(sum.condition() > wanted / 100);
    onEveryTarget([&](sk::Device& device) {
      CHECK(bits(exactSum(device, x)) == bits(sum.rounded()));
      const float second = sums::sum.with(compensated)(streamOf(device, x));
      CHECK(sum.errorOf(second) <= (u + 400 * u * u * sum.condition()) * std::fabs(sum.value()));
    });
  }
}

TEST_CASE("any floats at all, of every exponent") {
  for (const std::size_t n : {1U, 2U, 3U, 31U, 32U, 33U, 1021U, 4093U, 65537U}) {
    const std::vector<float> x = anyFloats(n, static_cast<unsigned>(n));
    onEveryTarget([&](sk::Device& device) {
      INFO(n << " elements");
      CHECK(bits(exactSum(device, x)) == bits(trueSum(x)));
    });
  }
}

TEST_CASE("small sums, where the denormals are, and ties") {
  const std::vector<std::vector<float>> all = {{denormal},
                                               {denormal, denormal},
                                               {-denormal, denormal, -denormal},
                                               {0x1p-126F, -denormal},
                                               {0x1p-126F, denormal},
                                               {0x1.fffffep-127F, denormal},
                                               {0x1p24F, 1},
                                               {0x1p24F, 1, denormal},
                                               {0x1p24F, 3},
                                               {0x1p24F, 1, -denormal},
                                               {0x1.fffffep24F, 1},
                                               {-0x1p24F, -1},
                                               {-0x1p24F, -1, -denormal},
                                               {-0x1p24F, -3},
                                               {0x1p127F, 0x1p127F, -denormal},
                                               {0x1.fffffep127F, 0x1p102F},
                                               {0x1.fffffep127F, 0x1.fffffep102F},
                                               {0x1.fffffep127F, 0x1p103F},
                                               {-0x1.fffffep127F, -0x1p103F},
                                               {0x1p127F, 0x1p127F, -0x1p104F}};
  for (const std::vector<float>& x : all) {
    onEveryTarget([&](sk::Device& device) {
      INFO(x[0] << " and " << x.size() - 1 << " more");
      CHECK(bits(exactSum(device, x)) == bits(trueSum(x)));
    });
  }
  std::vector<float> many;
  for (const float v : anyFloats(5000, 3)) many.push_back(std::bit_cast<float>(bits(v) & 0x807fffffU));
  onEveryTarget([&](sk::Device& device) { CHECK(bits(exactSum(device, many)) == bits(trueSum(many))); });
}

TEST_CASE("long sums of zeros, and what is not finite among many") {
  for (const std::size_t n : {15U, 16U, 1024U, 5003U}) {
    std::vector<float> x(n, -0.0F);
    const auto sumOf = [&] { return bits(exactSum(run_tests::device("native"), x)); };
    CHECK(sumOf() == bits(-0.0F));
    x[n / 2] = 0.0F;
    CHECK(sumOf() == 0);
    x[n / 3] = -denormal;
    CHECK(sumOf() == bits(-denormal));
    x[n - 1] = 3e38F;
    CHECK(sumOf() == bits(3e38F));
    x[n / 4] = -inf;
    CHECK(sumOf() == bits(-inf));
    x[0] = inf;
    CHECK(sumOf() == 0x7fc00000U);
    x[0] = nan;
    CHECK(sumOf() == 0x7fc00000U);
  }
}

TEST_CASE("magnitudes that are near each other and far apart") {
  std::mt19937 random(17);
  for (const int spread : {0, 18, 40, 62, 90, 200}) {
    std::vector<float> x(40'000);
    for (float& v : x) {
      const auto exponent = static_cast<int>(random() % static_cast<unsigned>(spread + 1)) - spread / 2;
      v = std::ldexp(1 + static_cast<float>(random() % (1U << 23U)) * 0x1p-23F, exponent);
      if ((random() & 1U) != 0) v = -v;
    }
    CHECK(bits(exactSum(run_tests::device("native"), x)) == bits(trueSum(x)));
  }
}

TEST_CASE("order and shape change no bit") {
  std::vector<float> x = illConditionedSum(5040, 1e20, 5);
  const std::uint32_t expected = bits(trueSum(x));
  std::mt19937 random(1);
  for (int round = 0; round < 4; ++round) {
    std::shuffle(x.begin(), x.end(), random);
    onEveryTarget([&](sk::Device& device) {
      for (const sk::Shape& shape : {sk::Shape(5040), sk::Shape(1, 5040), sk::Shape(5040, 1),
                                     sk::Shape(72, 70), sk::Shape(9, 8, 70), sk::Shape(2, 3, 7, 120)}) {
        CHECK(bits(sums::sum.with(exact)(streamOf(device, x, shape))) == expected);
      }
    });
  }
  run_tests::onEveryLayout([&](sk::Device& device) { CHECK(bits(exactSum(device, x)) == expected); });
}

TEST_CASE("Kahan's killers, and what cancels in another order") {
  std::vector<float> x = {1e8F, 1, -1e8F};
  std::sort(x.begin(), x.end());
  onEveryTarget([&](sk::Device& device) {
    do {
      CHECK(exactSum(device, x) == 1.0F);
      CHECK(sums::sum.with(compensated)(streamOf(device, x)) == 1.0F);
    } while (std::next_permutation(x.begin(), x.end()));
    const std::vector<float> killer = {1, 0x1p60F, 1, -0x1p60F};
    CHECK(exactSum(device, killer) == 2.0F);
    CHECK(sums::sum.with(compensated)(streamOf(device, killer)) == 2.0F);  // Neumaier's variant does it, too
    CHECK(exactSum(device, {1, 0x1p120F, 0x1p-100F, -0x1p120F, -1}) == 0x1p-100F);
  });
}

TEST_CASE("2^24 + 1 ones and tenths") {
  const std::size_t n = (1U << 24U) + 1;
  const auto tenths = static_cast<float>(static_cast<double>(0.1F) * static_cast<double>(n));
  sk::Device& device = run_tests::device("glsl330");
  auto x = streamOf(device, std::vector<float>(n, 1.0F));
  CHECK(sums::sum.with(exact)(x) == 0x1p24F);  // a tie, to even
  x.write(std::vector<float>(n, 0.1F));
  CHECK(sums::sum.with(exact)(x) == tenths);
  CHECK(sums::sum.with(compensated)(x) == tenths);
}

TEST_CASE("infinities and NaN, as IEEE 754 adds them") {
  onEveryTarget([](sk::Device& device) {
    CHECK(exactSum(device, {1, inf, -3e38F}) == inf);
    CHECK(exactSum(device, {1, -inf, 3e38F, -inf}) == -inf);
    CHECK(bits(exactSum(device, {inf, 1, -inf})) == 0x7fc00000U);
    CHECK(bits(exactSum(device, {1, nan, 2})) == 0x7fc00000U);
    CHECK(bits(exactSum(device, {inf, nan})) == 0x7fc00000U);
    CHECK(sums::sum.with(compensated)(streamOf<float>(device, {1, inf, 2})) == inf);
    CHECK(std::isnan(sums::sum.with(compensated)(streamOf<float>(device, {inf, -inf}))));
  });
}

TEST_CASE("partial sums overflow, and the sum does not") {
  onEveryTarget([](sk::Device& device) {
    CHECK(exactSum(device, {3e38F, 3e38F, -3e38F, -3e38F}) == 0.0F);
    std::vector<float> x(4096, 3.4e38F);
    std::fill(x.begin() + 2048, x.end(), -3.4e38F);
    x.push_back(1.5F);
    CHECK(exactSum(device, x) == 1.5F);
    CHECK(exactSum(device, {3e38F, 3e38F}) == inf);
    CHECK(exactSum(device, {-3e38F, -3e38F}) == -inf);
    // Beyond the range of floats, and rounded up to a power of 2.
    CHECK(exactSum(device, {0x1.fffffep127F, 0x1.fffffep127F, 0x1p104F, 0x1p103F}) == inf);
    CHECK(exactSum(device, {-0x1.fffffep127F, -0x1.fffffep127F, -0x1p104F, -0x1p103F}) == -inf);
  });
}

TEST_CASE("zeros, and no element") {
  onEveryTarget([](sk::Device& device) {
    CHECK(bits(exactSum(device, {-0.0F, -0.0F})) == bits(-0.0F));
    CHECK(bits(exactSum(device, {-0.0F, 0.0F})) == 0);
    CHECK(bits(exactSum(device, {1.0F, -1.0F})) == 0);
    CHECK(bits(exactSum(device, {})) == 0);
    CHECK(sums::sumFrom.with(exact)(streamOf<float>(device, {})) == 0.0F);
    const sk::Rows rows(streamOf<std::int32_t>(device, {0, 0, 1, 3, 3, 4}));
    auto inRows = device.stream<float>({5});
    sums::sum.with(exact)(rows(streamOf<float>(device, {-0.0F, -0.0F, -0.0F, 0.0F})), inRows);
    std::vector<std::uint32_t> got;
    for (const float x : inRows.read()) got.push_back(bits(x));
    CHECK(got == std::vector<std::uint32_t>{0, bits(-0.0F), bits(-0.0F), 0, 0});
  });
}

TEST_CASE("an identity adds nothing") {
  onEveryTarget([](sk::Device& device) {
    CHECK(sums::sumFrom.with(exact)(streamOf<float>(device, {0x1p30F, 1, -0x1p30F})) == 1.0F);
    CHECK(sums::sumFrom.with(exact)(streamOf(device, std::vector<float>(1000, 0.25F))) == 250.0F);
  });
}

TEST_CASE("vectors, a sum for each component") {
  const std::vector<float> a = illConditionedSum(999, 1e18, 11);
  std::vector<sk::float3> v;
  std::vector<float> scaled;
  for (const float x : a) {
    v.push_back({x, -4 * x, 1});
    scaled.push_back(-4 * x);
  }
  run_tests::onEveryLayout([&](sk::Device& device) {
    const sk::float3 total = sums::sumVectors.with(exact)(streamOf(device, v));
    CHECK(bits(total.x) == bits(trueSum(a)));
    CHECK(bits(total.y) == bits(trueSum(scaled)));
    CHECK(total.z == 999.0F);
  });
}

TEST_CASE("sums beside other accumulators, with a uniform and an early return") {
  std::vector<float> x = illConditionedSum(999, 1e12, 12);
  TrueSum sum;
  std::int32_t n = 0;
  for (const float v : x) {
    if (v != 0) sum.addProduct(3, v - 1), ++n;  // v - 1 is rounded, the product is not
  }
  onEveryTarget([&](sk::Device& device) {
    const auto [total, most, count] = sums::sumBeside.with(exact)(streamOf(device, x), 3.0F);
    CHECK(bits(total) == bits(sum.rounded()));
    CHECK(most == *std::max_element(x.begin(), x.end()));
    CHECK(count == n);
  });
}

TEST_CASE("several summands an element, in a loop, from a gather") {
  const std::vector<float> x = illConditionedSum(2003, 1e12, 13);
  const std::vector<float> weights = {1.1F, -0x1p40F, 0x1p-90F};
  TrueSum sum;
  for (const float v : x) {
    for (const float w : weights) sum.addProduct(v, w);
  }
  onEveryTarget([&](sk::Device& device) {
    const auto w = streamOf(device, weights);
    CHECK(bits(sums::sumGathered.with(exact)(streamOf(device, x), w)) == bits(sum.rounded()));
  });
}

TEST_CASE("members of a struct, and components in another order") {
  const std::vector<float> x = illConditionedSum(2003, 1e12, 14);
  TrueSum squares;
  for (const float v : x) squares.addProduct(v, v);
  run_tests::onEveryLayout([&](sk::Device& device) {
    const sums::Moments m = sums::moments.with(exact)(streamOf(device, x));
    CHECK(m.n == 2003.0F);
    CHECK(bits(m.sum.x) == bits(trueSum(x)));
    CHECK(bits(m.sum.y) == bits(squares.rounded()));
    CHECK(m.most == *std::max_element(x.begin(), x.end()));
  });
}

TEST_CASE("several terms of members, which an element may leave out") {
  const std::vector<float> x = illConditionedSum(2003, 1e12, 18);
  const std::vector<float> y = illConditionedSum(2003, 1e10, 19);
  TrueSum positive, greater, less;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] > 0) {
      positive.add(x[i]);
      greater.add(y[i] - 1);
    } else {
      less.add(x[i]);
      less.add(-y[i]);
    }
  }
  onEveryTarget([&](sk::Device& device) {
    const sums::Signs s = sums::signs.with(exact)(streamOf(device, x), streamOf(device, y));
    CHECK(s.n == 2003);
    CHECK(bits(s.positive) == bits(positive.rounded()));
    CHECK(bits(s.others.x) == bits(greater.rounded()));
    CHECK(bits(s.others.y) == bits(less.rounded()));
    const std::vector<float> none(70, -1.0F);  // a sum to which no element adds is its identity
    CHECK(bits(sums::signs.with(exact)(streamOf(device, none), streamOf(device, none)).positive) ==
          bits(0.0F));
  });
}

TEST_CASE("ill-conditioned sums of members, combined by the compiler and by the author") {
  for (const double wanted : {1e6, 1e10, 1e14}) {  // squares would overflow at larger condition numbers
    const std::vector<float> x = illConditionedSum(4001, wanted, 15);
    TrueSum sum;
    TrueSum squares;
    for (const float v : x) sum.add(v), squares.addProduct(v, v);
    INFO("condition " << sum.condition());
    const auto withinBound = [](const TrueSum& expected, float result) {
      return expected.errorOf(result) <=
             (u + 400 * u * u * expected.condition()) * std::fabs(expected.value());
    };
    onEveryTarget([&](sk::Device& device) {
      const auto stream = streamOf(device, x);
      const sums::Moments m = sums::moments.with(compensated)(stream);
      CHECK(withinBound(sum, m.sum.x));
      CHECK(withinBound(squares, m.sum.y));
      CHECK(m.n == 4001.0F);
      CHECK(m.most == *std::max_element(x.begin(), x.end()));
      const sums::Totals t = sums::totals.with(compensated)(stream);
      CHECK(withinBound(sum, t.sum));
      CHECK(withinBound(sum, t.scaled.x));
      CHECK(withinBound(sum, -t.scaled.y / 4));
      CHECK(t.n == 4001);
      auto results = device.stream<sums::Totals>({1});
      sums::totals.with(compensated)(stream, results);
      CHECK(withinBound(sum, results.read()[0].sum));
      CHECK(withinBound(sum, results.read()[0].scaled.x));
      const sums::Totals e = sums::totals.with(exact)(stream);
      CHECK(bits(e.sum) == bits(sum.rounded()));
      CHECK(bits(e.scaled.x) == bits(sum.rounded()));
      CHECK(e.n == 4001);
    });
  }
}

TEST_CASE("infinities in members, and what cancels there") {
  onEveryTarget([](sk::Device& device) {
    const auto sum = [&](const std::vector<float>& x) {
      return sums::totals.with(compensated)(streamOf(device, x));
    };
    CHECK(sum({1, inf, 2}).sum == inf);
    CHECK(sum({3e38F, 3e38F, 1}).scaled.x == inf);
    CHECK(std::isnan(sum({inf, -inf}).sum));
    CHECK(sum({1, 0x1p60F, 1, -0x1p60F}).sum == 2.0F);
    CHECK(sum({}).scaled.y == 0.0F);
  });
}

TEST_CASE("sums of rows, into a view of a larger stream") {
  constexpr std::int64_t rows = 3;
  constexpr std::size_t columns = 1201;
  std::vector<float> x;
  std::vector<float> expected;
  for (unsigned r = 0; r < rows; ++r) {
    const std::vector<float> row = illConditionedSum(columns, 1e20, 20 + r);
    expected.push_back(trueSum(row));
    x.insert(x.end(), row.begin(), row.end());
  }
  run_tests::onEveryLayout([&](sk::Device& device) {
    const auto a = streamOf(device, x, sk::Shape(rows, columns));
    auto r = streamOf(device, std::vector<float>(2 * (rows + 2), 7.0F), sk::Shape(rows + 2, 2));
    sums::sum.with(exact)(a, r.domain({1, 1}, {rows + 1, 2}));
    const std::vector<float> result = r.read();
    for (std::size_t i = 0; i < rows; ++i) {
      CHECK(bits(result[2 * (i + 1) + 1]) == bits(expected[i]));
      CHECK(result[2 * i] == 7.0F);
    }
  });
}

TEST_CASE("what sums no floats is refused") {
  sk::Device& device = run_tests::device("glsl330");
  CHECK_THROWS_WITH(sums::largest.with(exact)(streamOf<float>(device, {1, 2})),
                    Catch::Contains("largest") && Catch::Contains("no sum of floats"));
  const auto x = streamOf<float>(device, {1, 2});
  CHECK_THROWS_WITH(sums::withMatrix.with(exact)(x), Catch::Contains("others beside it that cannot be"));
  CHECK_THROWS_WITH(sums::halved.with(exact)(x), Catch::Contains("others beside it that cannot be"));
  CHECK(sums::halved(x).s == 3);
}

/// Terms of up to 2^50 that cancel except for two small ones, in an order in which sums of doubles must round.
std::vector<float> cancellingTerms(std::size_t pairs) {
  std::mt19937 random(50);
  std::uniform_real_distribution<float> mantissas(0.5F, 1.0F);
  std::uniform_int_distribution<int> exponents(0, 50);
  std::vector<float> terms{0.146521524F, 0x1p-60F};
  for (std::size_t i = 1; i < pairs; ++i) {
    const float term = std::ldexp(mantissas(random), exponents(random));
    terms.push_back(term);
    terms.push_back(-term);
  }
  std::shuffle(terms.begin(), terms.end(), random);
  return terms;
}

TEST_CASE("exact sums are exact on the reference, too") {
  const std::vector<float> terms = cancellingTerms(400'000);
  TrueSum sum;
  for (const float term : terms) sum.add(term);
  sk::Device device = sk::Device::reference();
  const auto x = streamOf(device, terms, {8, 100'000});
  // Shows that the terms are hard enough: a compensated sum of doubles loses bits.
  CHECK(bits(sums::sum.with(compensated)(x)) != bits(sum.rounded()));
  CHECK(bits(sums::sum.with(exact)(x)) == bits(sum.rounded()));
  auto total = device.stream<float>({1, 1});
  sums::sum.with(exact)(x, total);
  CHECK(total.readReals()[0] == sum.value());
  auto rows = device.stream<float>({8, 1});
  sums::sum.with(exact)(x, rows);
  TrueSum second;
  for (std::size_t i = 100'000; i < 200'000; ++i) second.add(terms[i]);
  CHECK(rows.readReals()[1] == second.value());
  for (const std::size_t n : {1U, 33U, 4093U}) {
    const std::vector<float> any = anyFloats(n, static_cast<unsigned>(n));
    CHECK(bits(exactSum(device, any)) == bits(trueSum(any)));
  }
}

TEST_CASE("exact sums on the reference leave what is beside them in its own precision") {
  sk::Device device = sk::Device::reference();
  auto x = device.stream<float>({2});
  x.writeReals(std::vector<double>{1 + 0x1p-40, 0x1p-60});
  CHECK(std::get<2>(sums::sumBeside.with(exact)(x, 1.0F)) == 2);
  auto totals = device.stream<float>({1}), mosts = device.stream<float>({1});
  auto counts = device.stream<int>({1});
  sums::sumBeside.with(exact)(x, 1.0F, totals, mosts, counts);
  CHECK(totals.readReals()[0] == -1 + 0x1p-40);
  CHECK(mosts.readReals()[0] == 1 + 0x1p-40);
}

TEST_CASE("the reference of doubles takes what is closest") {
  sk::Device device = sk::Device::reference();
  CHECK(exactSum(device, {1e8F, 1, -1e8F}) == 1.0F);
  CHECK(sums::sum.with(tree)(streamOf<float>(device, {1, 2})) == 3.0F);
}

}  // namespace
}  // namespace numerics
