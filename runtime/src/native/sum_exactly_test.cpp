// SPDX-License-Identifier: MIT
//
// Tests exact sums against integers that hold every bit, and with infinities and NaN.
#include "native/sum_exactly.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "native/exact_accumulator.hpp"
#include "native/object_code_test.hpp"

namespace sk::test {
namespace {

using native::Chunk;
using native::EntryKind;
using native::Extents;
using native::Frame;
using program::Role;
using Of = ExactAccumulator::Of;
__extension__ typedef __int128 Wide;

constexpr float infinity = std::numeric_limits<float>::infinity();

float exactSum(const std::vector<float>& x) {
  ExactAccumulator sum(Of::Floats);
  sum.add(static_cast<std::int64_t>(x.size()), x.data());
  return sum.rounded();
}
float exactDot(const std::vector<float>& x, const std::vector<float>& y) {
  ExactAccumulator sum(Of::Products);
  sum.add(static_cast<std::int64_t>(x.size()), x.data(), y.data());
  return sum.rounded();
}

/// Floats of up to 24 bits at exponents from -40 to 39, and 2^40 times each of them.
std::vector<float> spreadFloats(std::size_t count, std::vector<Wide>& scaled) {
  std::vector<float> values;
  std::uint64_t state = 12345;
  for (std::size_t i = 0; i < count; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const auto mantissa = static_cast<std::int64_t>(state >> 40) - (1 << 23);
    const int exponent = static_cast<int>(state >> 20 & 1023) % 80;
    values.push_back(std::ldexp(static_cast<float>(mantissa), exponent - 40));
    scaled.push_back(Wide{mantissa} << exponent);
  }
  return values;
}

float nearest(Wide scaled, int exponent) { return std::ldexp(static_cast<float>(scaled), exponent); }

TEST_CASE("a sum of floats is rounded once") {
  for (const std::size_t count : {1, 2, 15, 16, 17, 1000, 1024, 5000}) {
    std::vector<Wide> scaled;
    const std::vector<float> x = spreadFloats(count, scaled);
    Wide sum = 0;
    for (const Wide value : scaled) sum += value;
    CAPTURE(count);
    CHECK(exactSum(x) == nearest(sum, -40));
  }
}

TEST_CASE("a sum of products rounds none of them") {
  const std::vector<float> x = someFloats(3001, 1);
  std::vector<float> y = someFloats(3001, 2);
  Wide sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    y[i] = y[i] * 16777.0F + 1.0F;  // products of more bits than a float has
    sum += Wide{static_cast<std::int64_t>(x[i])} * static_cast<std::int64_t>(y[i]);
  }
  CHECK(exactDot(x, y) == nearest(sum, 0));
}

template <class Real>
Real wideSum(const std::vector<Real>& x) {
  WideSum<Real> sum;
  sum.add(static_cast<std::int64_t>(x.size()), x.data());
  return sum.rounded();
}

TEST_CASE("sums of doubles and of wider numbers are rounded once, too") {
  using native::Quad;
  const double most = std::numeric_limits<double>::max();
  const double least = std::numeric_limits<double>::denorm_min();
  const double inf = std::numeric_limits<double>::infinity();
  CHECK(wideSum<double>({}) == 0);
  CHECK(std::signbit(wideSum<double>({-0.0, -0.0})));
  CHECK_FALSE(std::signbit(wideSum<double>({-0.0, 0.0})));
  CHECK(wideSum<double>({most, least, -most}) == least);
  CHECK(wideSum<double>({-least, -most, most}) == -least);
  CHECK(wideSum<double>({most, most}) == inf);
  CHECK(wideSum<double>({-most, -most}) == -inf);
  CHECK(wideSum<double>({most, -1}) == most);
  CHECK(std::isnan(wideSum<double>({inf, 1, -inf})));
  CHECK(wideSum<double>({1, 0x1p-53}) == 1);                      // a tie, to even
  CHECK(wideSum<double>({1, 0x1p-53, 0x1p-1000}) == 1 + 0x1p-52);  // and above it
  CHECK(wideSum<double>({1 + 0x1p-52, 0x1p-53}) == 1 + 0x1p-51);
  CHECK(wideSum<double>({-1, -0x1p-53, -0x1p-1000}) == -1 - 0x1p-52);
  CHECK(wideSum<double>({0x1.8p-1022, -0x1p-1022}) == 0x1p-1023);
  std::vector<double> falling;
  for (int i = 1000; i > -1000; i -= 3)
    falling.insert(falling.end(), {std::ldexp(3.0, i), -std::ldexp(1.0, i)});
  WideSum<double> together, first, second;
  const auto half = static_cast<std::int64_t>(falling.size() / 2);
  together.add(2 * half, falling.data());
  first.add(half, falling.data());
  second.add(half, falling.data() + half);
  second.add(first);
  CHECK(second.rounded() == together.rounded());
  const Quad one = 1;
  CHECK(wideSum<Quad>({one, one / 3, -one}) == one / 3);
  CHECK(wideSum<Quad>({one, Quad{0x1p-120}, -one}) == Quad{0x1p-120});
  WideSum<Quad> products;
  const Quad x[] = {one + Quad{0x1p-100}, -one}, y[] = {one - Quad{0x1p-100}, one};
  products.add(2, x, y);
  CHECK(products.rounded() == -Quad{0x1p-200});
}

TEST_CASE("no range is too wide for an exact sum") {
  const float most = std::numeric_limits<float>::max();
  const float least = std::numeric_limits<float>::denorm_min();
  CHECK(exactSum({most, least, -most}) == least);
  CHECK(exactSum({most, most}) == infinity);
  CHECK(exactSum({-most, -most}) == -infinity);
  CHECK(exactSum({most, most, -most}) == most);
  CHECK(exactDot({most, least, most}, {most, 1, -most}) == least);
  CHECK(exactDot({least, 1}, {least, least}) == least);
  CHECK(exactDot({least}, {0.5F}) == 0);  // a tie, to even
}

TEST_CASE("zeros, infinities and NaN are as in IEEE sums") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(std::signbit(exactSum({-0.0F, -0.0F})));
  CHECK(!std::signbit(exactSum({-0.0F, 0.0F})));
  CHECK(!std::signbit(exactSum({1, -1})));
  std::vector<float> x(16, -0.0F), y(16, 5);  // all products are -0, though both factors have other terms
  x[0] = 1;
  y[0] = -0.0F;
  CHECK(std::signbit(exactDot(x, y)));
  y[0] = 0;
  CHECK(!std::signbit(exactDot(x, y)));
  CHECK(exactSum({infinity, 1}) == infinity);
  CHECK(exactSum({-infinity, 1}) == -infinity);
  CHECK(std::isnan(exactSum({infinity, -infinity})));
  CHECK(std::isnan(exactSum({nan, infinity})));
  CHECK(std::isnan(exactDot({0}, {infinity})));
  CHECK(exactDot({-1}, {infinity}) == -infinity);
  CHECK(std::signbit(exactDot({-0.0F}, {1})));
  std::vector<float> many(100, 1);
  many[50] = infinity;
  CHECK(exactSum(many) == infinity);
}

// ---- of reductions ---------------------------------------------------------------------------------

void oneHundred(const Frame*, void* const* values) { *static_cast<float*>(values[0]) = 100; }

/// Writes both factors of x * x, and of x * 1: an element adds two terms.
void squares(const Frame*, const Chunk* chunk) {
  const auto* x = arrayOf<float>(chunk, 0);
  for (std::int64_t i = 0; i < inGroups(chunk->count); ++i) {
    arrayOf<float>(chunk, 1)[i] = arrayOf<float>(chunk, 2)[i] = x[i];
    arrayOf<float>(chunk, 3)[i] = x[i];
    arrayOf<float>(chunk, 4)[i] = 1;
  }
}

const Extents domains[] = {{1, 1, 1, 1}, {100, 7, 1, 1}, {70001, 1, 1, 1}, {600, 90, 1, 1}};

/// Checks the exact sum of each row, plus 100: of x or, if a kernel computes the terms, of x * x + x.
void checkRows(const Extents& domain, bool byKernel, std::int64_t multiply) {
  TestKernel fold, terms;
  for (TestKernel* kernel : {&fold, &terms}) kernel->add(Role::Input);
  fold.add(Role::Accumulator);
  fold.entries = {entry(EntryKind::Identity, &oneHundred)};
  for (int i = 0; i < 4; ++i) terms.add(Role::Output);
  for (std::uint8_t i = 0; i < 5; ++i) terms.slot(i);
  terms.entries = {entry(EntryKind::Run, &squares)};
  program::Reduction reduction{};
  reduction.fold = fold.finish();
  program::ExactSum sum{};
  sum.accumulator = 1;
  sum.ofProducts = byKernel;
  const std::uint8_t factors[] = {0};
  if (byKernel) {
    sum.term.kernel = &terms.finish();
  } else {
    sum.term.factors = factors;
  }
  std::vector<float> x = someFloats(domain[0] * domain[1] * multiply);
  for (float& value : x) value *= 65537;
  TestOperands operands;
  native::Operand& input = operands.add(x, domain);
  input.multiply[0] = multiply;
  input.stride[1] = domain[0] * multiply;
  for (int i = 0; i < 4; ++i) operands.addNone();
  const std::vector<float> sums =
      sumExactly<float>(reduction, sum, operands.call(domain), {domain[0], 1, 1, 1}, {});
  std::vector<float> expected;
  for (std::int64_t row = 0; row < domain[1]; ++row) {
    Wide total = 100;
    for (std::int64_t i = 0; i < domain[0]; ++i) {
      const Wide value =
          static_cast<std::int64_t>(x[static_cast<std::size_t>((row * domain[0] + i) * multiply)]);
      total += byKernel ? value * value + value : value;
    }
    expected.push_back(nearest(total, 0));
  }
  CAPTURE(domain[0], domain[1], byKernel, multiply);
  CHECK(sums == expected);
}

TEST_CASE("each block has its exact sum, the identity once among the terms") {
  for (const Extents& domain : domains) {
    for (const bool byKernel : {false, true}) {
      for (const std::int64_t multiply : {1, 2}) checkRows(domain, byKernel, multiply);
    }
  }
}

}  // namespace
}  // namespace sk::test
