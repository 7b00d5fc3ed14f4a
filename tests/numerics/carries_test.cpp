// SPDX-License-Identifier: MIT
//
// Promises: exact sums are exact however many carries meet in a digit: in rows, along each dimension, in blocks, in elements
// that add many terms. The trees of additions are as deep as docs/accuracy.md says. Every mode has the signs of zero,
// infinities and NaN that are stated there.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
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
using run_tests::onGlAndNative;
using run_tests::streamOf;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr sk::CallOptions exact{.accumulate = sk::Accumulate::Exact};
constexpr sk::CallOptions compensated{.accumulate = sk::Accumulate::Compensated};
constexpr sk::CallOptions tree{.accumulate = sk::Accumulate::Tree};

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

/// Has all bits of its mantissa set. The powers of two put these bits at each place of a digit of 26 bits.
float fullMantissa(int power) { return std::ldexp(0x1.fffffep0F, power); }
constexpr int powersOfDigit = 26;

std::size_t differences(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t count = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += bits(a[i]) != bits(b[i]) ? 1 : 0;
  return count;
}

/// The sums of the elements up to each, which doubles hold exactly.
std::vector<float> prefixSums(const std::vector<float>& x, std::size_t first, std::size_t end,
                              std::size_t step = 1) {
  std::vector<double> sums;
  double sum = 0;
  for (std::size_t i = first; i < end; i += step) sums.push_back(sum += x[i]);
  return {sums.begin(), sums.end()};
}

TEST_CASE("prefix sums in rows carry") {
  const std::vector<int> starts = {0, 3, 43, 74, 139, 800};
  onEveryTarget([&](sk::Device& device) {
    const sk::Rows rows(streamOf(device, starts));
    const auto count = static_cast<std::size_t>(starts.back());
    auto x = device.stream<float>({starts.back()}), s = device.stream<float>({starts.back()});
    const auto y = streamOf(device, std::vector<float>(count, 0x1.fffffep0F));
    for (const int power : {0, 3, 6, 19}) {
      const std::vector<float> full(count, fullMantissa(power));
      x.write(full);
      sums::prefix.with(exact)(rows(x), s);
      std::vector<float> got = s.read();
      for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
        const auto first = static_cast<std::size_t>(starts[row]),
                   end = static_cast<std::size_t>(starts[row + 1]);
        INFO("2^" << power << ", row " << row);
        const auto at = got.begin();
        CHECK(differences({at + starts[row], at + starts[row + 1]}, prefixSums(full, first, end)) == 0);
      }
      sums::prefixOfProducts.with(exact)(rows(x), rows(y), s);
      TrueSum sum;
      for (std::size_t i = 139; i < count; ++i) sum.addProduct(full[i], 0x1.fffffep0F);
      CHECK(s.read().back() == sum.rounded());
    }
  });
}

TEST_CASE("prefix sums along each dimension carry") {
  constexpr std::size_t rows = 200, columns = 5;
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> full(rows * columns, fullMantissa(6));
    const auto x = streamOf(device, full, {rows, columns});
    auto s = device.stream<float>({rows, columns});
    for (const sk::Target target : {sk::Target::Default, sk::Target::Compute}) {
      if (target == sk::Target::Compute && device.profile() != "glsl430") continue;
      sums::prefix.with(exact).with({.target = target, .along = 0})(x, s);
      std::vector<float> first;
      const std::vector<float> got = s.read();
      for (std::size_t i = 0; i < got.size(); i += columns) first.push_back(got[i]);
      CHECK(differences(first, prefixSums(full, 0, full.size(), columns)) == 0);
      sums::prefix.with(exact).with({.target = target})(x, s);
      CHECK(differences(s.read(), prefixSums(full, 0, full.size())) == 0);
    }
  });
}

TEST_CASE("large blocks carry") {
  onEveryTarget([](sk::Device& device) {
    for (const std::int64_t length : {512, 8192, 40004, 300001}) {
      auto x = device.stream<float>({3, length});
      auto sums = device.stream<float>({3, 1});
      for (const int power : {6, 13}) {
        x.fill(fullMantissa(power));
        sums::sum.with(exact)(x, sums);
        const auto right =
            static_cast<float>(static_cast<double>(fullMantissa(power)) * static_cast<double>(length));
        INFO(length << " elements, 2^" << power);
        CHECK(sums.read() == std::vector<float>(3, right));
      }
    }
  });
}

TEST_CASE("carries at each place of a digit, in sums of many lengths") {
  onEveryTarget([](sk::Device& device) {
    for (const std::int64_t length : {31, 32, 33, 255, 4097}) {
      auto x = device.stream<float>({length});
      for (int power = 0; power < powersOfDigit; ++power) {
        for (const float sign : {1.0F, -1.0F}) {
          x.fill(sign * fullMantissa(power));
          const auto right = static_cast<float>(sign * static_cast<double>(fullMantissa(power)) *
                                                static_cast<double>(length));
          if (sums::sum.with(exact)(x) != right) FAIL_CHECK(length << " times 2^" << power << " * " << sign);
        }
      }
    }
  });
}

TEST_CASE("many terms of an element carry") {
  constexpr std::size_t count = 70;
  onGlAndNative([](sk::Device& device) {
    for (const int power : {0, 6}) {
      INFO("2^" << power);
      const float full = fullMantissa(power);
      const auto x = streamOf(device, std::vector<float>(count, full));
      const auto times = [&](double terms) { return static_cast<float>(full * terms); };
      CHECK(sums::around.with(exact)(x, x) == times(48 * count));
      TrueSum products, one;
      for (std::size_t i = 0; i < 40; ++i) one.addProduct(full, full);
      for (std::size_t i = 0; i < 40 * count; ++i) products.addProduct(full, full);
      CHECK(sums::productsAround.with(exact)(x, x) == products.rounded());
      CHECK(sums::productsAround.with(exact)(streamOf<float>(device, {full}), x) == one.rounded());
      CHECK(sums::manyAround.with(exact)(x, x) == times(320 * count));
      auto s = device.stream<float>({count});
      sums::prefixAround.with(exact)(x, x, s);
      std::vector<float> each;
      for (std::size_t i = 1; i <= count; ++i) each.push_back(times(48.0 * static_cast<double>(i)));
      CHECK(differences(s.read(), each) == 0);
    }
  });
}

TEST_CASE("elements that add different numbers of terms carry") {
  onGlAndNative([](sk::Device& device) {
    for (const std::size_t count : {32U, 3000U}) {
      const float full = fullMantissa(6);
      std::vector<int> loops(count), kinds(count);
      auto ofLoops = static_cast<double>(count), ofKinds = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        loops[i] = i % 32 == 0 ? static_cast<int>(i / 32 % 7 + 1) : 0;
        kinds[i] = static_cast<int>(i % 3);
        ofLoops += loops[i];
        ofKinds += kinds[i] == 2 ? 2 : 1;
      }
      const auto x = streamOf(device, std::vector<float>(count, full));
      CHECK(sums::uneven.with(exact)(x, x, streamOf(device, loops)) == static_cast<float>(full * ofLoops));
      CHECK(sums::either.with(exact)(x, x, streamOf(device, kinds)) == static_cast<float>(full * ofKinds));
    }
  });
}

TEST_CASE("carries from 2^-149 to 2^128, of one sign and of both") {
  std::vector<float> rising, alternating;
  for (int power = -149; power < 128; ++power) {
    for (int k = 0; k < 40; ++k) {
      rising.push_back(fullMantissa(power));
      alternating.push_back(k % 2 == 0 ? fullMantissa(power) : -fullMantissa(-power - 22));
    }
  }
  std::vector<float> shuffled = rising;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(4));
  const std::vector<int> starts = {0, 41, 4000, static_cast<int>(rising.size())};
  onEveryTarget([&](sk::Device& device) {
    for (const std::vector<float>* all : {&rising, &shuffled, &alternating}) {
      std::vector<float> x = *all;
      x[17] = std::numeric_limits<float>::max();  // so that sums of rows overflow
      x[5000] = -x[17];
      const auto in = streamOf(device, x);
      TrueSum whole;
      for (const float v : x) whole.add(v);
      CHECK(bits(sums::sum.with(exact)(in)) == bits(whole.rounded()));
      const sk::Rows rows(streamOf(device, starts));
      auto s = device.stream<float>({static_cast<std::int64_t>(x.size())});
      sums::prefix.with(exact)(rows(in), s);
      const std::vector<float> got = s.read();
      for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
        TrueSum sum;
        std::size_t wrong = 0;
        for (auto i = static_cast<std::size_t>(starts[row]); i < static_cast<std::size_t>(starts[row + 1]);
             ++i) {
          sum.add(x[i]);
          wrong += bits(got[i]) != bits(sum.rounded()) ? 1 : 0;
        }
        CHECK(wrong == 0);
      }
    }
  });
}

// ---- zeros, infinities and NaN, in every mode -----------------------------------------------------------

TEST_CASE("every mode has the signs of zero, the infinities and the NaN of IEEE 754") {
  struct Case {
    std::vector<float> x;
    float sum;  ///< from the first element
  };
  const Case cases[] = {{{-0.0F, -0.0F}, -0.0F},  {{-0.0F, 0.0F}, 0.0F},      {{1.5F, -1.5F}, 0.0F},
                        {{inf, 1, -3e38F}, inf},  {{1, -inf, -inf}, -inf},    {{inf, 2, -inf}, nan},
                        {{1, nan, 2}, nan},       {{-inf, nan}, nan},         {{3e38F, 3e38F}, inf},
                        {{-3e38F, -3e38F}, -inf}, {{0.0F, 0.0F, -0.0F}, 0.0F}};
  const auto isSame = [](float a, float b) { return std::isnan(b) ? std::isnan(a) : bits(a) == bits(b); };
  onGlAndNative([&](sk::Device& device) {
    for (const sk::CallOptions& mode : {tree, compensated, exact}) {
      for (const auto& [x, sum] : cases) {
        INFO("mode " << static_cast<int>(mode.accumulate) << ": " << x[0] << " and " << x[1] << ", ...");
        const auto in = streamOf(device, x);
        const float from0 = sum == 0 ? 0.0F : sum;  // the identity is a summand
        CHECK(isSame(sums::sum.with(mode)(in), sum));
        CHECK(isSame(sums::sumFrom.with(mode)(in), from0));
        auto one = device.stream<float>({1});
        sums::sum.with(mode)(in, one);
        CHECK(isSame(one.read()[0], sum));
        auto copy = device.stream<float>({static_cast<std::int64_t>(x.size())});
        auto total = device.scalar<float>();
        sums::copyAndSum.with(mode)(in, copy, total);
        CHECK(isSame(total.read(), from0));
        const sk::Rows rows(streamOf<int>(device, {0, static_cast<int>(x.size())}));
        sums::sum.with(mode)(rows(in), one);
        CHECK(isSame(one.read()[0], sum));
        auto each = device.stream<float>({static_cast<std::int64_t>(x.size())});
        sums::prefix.with(mode)(in, each);
        CHECK(isSame(each.read().back(), from0));
      }
    }
  });
}

// ---- near underflow ------------------------------------------------------------------------------------

TEST_CASE("compensated sums near underflow keep their bound") {
  constexpr double u = 0x1p-24;
  std::mt19937 random(7);
  const auto number = [&](int power) {
    return std::ldexp(1 + static_cast<float>(random() % (1U << 23U)) * 0x1p-23F, power);
  };
  onGlAndNative([&](sk::Device& device) {
    const bool isNative = device.profile() == "native";
    for (const int power : {-80, -94, -99, -105, -120}) {
      std::vector<float> x, y;
      TrueSum sum;
      for (int i = 0; i < 64; ++i) {  // products, less what they are rounded to, and numbers
        const float a = number(power / 2), b = number(power - power / 2), c = number(power);
        x.insert(x.end(), {a, -std::ldexp(a * b, -power / 2), c, -number(power)});
        y.insert(y.end(), {b, std::ldexp(1.0F, power / 2), 1, 1});
      }
      for (std::size_t i = 0; i < x.size(); ++i) sum.addProduct(x[i], y[i]);
      const auto count = static_cast<double>(x.size());
      const double depth = isNative ? count : 64 * std::ceil(std::log(count) / std::log(30.0));
      const double lost = count * (isNative ? 0x1p-149 : 0x1p-122);
      auto each = device.stream<float>({static_cast<std::int64_t>(x.size())});
      sums::prefixOfProducts.with(compensated)(streamOf(device, x), streamOf(device, y), each);
      INFO("2^" << power);
      CHECK(sum.errorOf(each.read().back()) <=
            u * std::fabs(sum.value()) + 2 * (depth + 1) * (depth + 1) * u * u * sum.magnitude() + lost);
    }
  });
}

// ---- the depth of trees -------------------------------------------------------------------------------

/// The additions that element i takes part in (Xie et al., FPRev: revealing floating-point accumulation orders, 2025): ones
/// that meet a large number are lost, until it cancels with another; the sum counts those that met neither before.
template <class Sum>
std::size_t additionsOf(std::size_t i, std::size_t count, Sum&& sumOf) {
  std::set<float> sums;  // one for each addition
  for (std::size_t k = 0; k < count; ++k) {
    if (k == i) continue;
    std::vector<float> x(count, 1.0F);
    x[i] = 0x1p60F;
    x[k] = -0x1p60F;
    sums.insert(sumOf(x));
  }
  return sums.size();
}

TEST_CASE("trees are as deep as stated") {
  onEveryTarget([](sk::Device& device) {
    const bool isNative = device.profile() == "native";
    const std::size_t count = isNative ? 3001 : 150;
    auto stream = device.stream<float>({static_cast<std::int64_t>(count)});
    const double log2 = std::log2(static_cast<double>(count));
    const double stated = isNative ? 24 + log2 : 31 * std::ceil(log2 / std::log2(30.0)) + 8;
    for (const std::size_t i : {std::size_t{0}, count / 2, count - 1}) {
      const std::size_t additions = additionsOf(i, count, [&](const std::vector<float>& x) {
        stream.write(x);
        return sums::sum.with(tree)(stream);
      });
      CHECK(static_cast<double>(additions) <= stated);
      if (i == 0) CHECK(static_cast<double>(additions) > log2 / 2);  // the first of a run
    }
  });
}

}  // namespace
}  // namespace numerics
