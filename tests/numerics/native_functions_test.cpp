// SPDX-License-Identifier: MIT
//
// Promises: the functions that native code calls for intrinsics (compiler/native/library) are within 0.51 ulp of the exact
// result over all floats, fmod is exact, and special cases are those of C99, annex F. The reference is MPFR.
//
// The bound has half a unit for the rounding to float, and 0.01 for the polynomials, whose errors float_functions.sk
// states, and for the roundings of doubles. docs/accuracy.md has the errors of every 61st of all floats: those that
// SK_STRIDE=61 makes this test measure, against the C library in double, whose error is some 1e-9 ulp of a float.
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "native_functions.sk.hpp"
#include "sk/sk.hpp"
#include "support/function_oracle.hpp"

namespace {

using numerics::FunctionOracle;

constexpr double bound = 0.51;

std::vector<float> computed(const auto& kernel, const auto&... arguments) {
  sk::Device device = sk::Device::native();
  const auto streamOf = [&](const std::vector<float>& values) {
    auto stream = device.stream<float>({static_cast<std::int64_t>(values.size())});
    stream.write(values);
    return stream;
  };
  const auto first = [](const std::vector<float>& x, const auto&...) { return x.size(); };
  auto result = device.stream<float>({static_cast<std::int64_t>(first(arguments...))});
  kernel(streamOf(arguments)..., result);
  return result.read();
}

/// The largest error, and where.
struct Worst {
  double error = 0;
  std::string where;

  void add(double ulps, float result, float x, float y = 0) {
    if (!(ulps > error)) return;
    std::ostringstream text;
    text << std::hexfloat << result << " of " << x << ", " << y;
    *this = {ulps, text.str()};
  }
};

struct UnaryCase {
  const char* name;
  std::vector<float> (*compute)(const std::vector<float>&);
  numerics::Unary exact;
  double (*nearlyExact)(double);
  float low, high;  ///< where the function does most
};

#define UNARY(f, low, high)                                                                   \
  UnaryCase {                                                                                 \
    #f, [](const std::vector<float>& x) { return computed(functions::of_##f, x); }, mpfr_##f, \
        [](double x) { return std::f(x); }, low, high                                         \
  }

const UnaryCase unaryCases[] = {
    UNARY(sin, -10, 10),   UNARY(cos, -10, 10),    UNARY(tan, -10, 10),  UNARY(asin, -1, 1),
    UNARY(acos, -1, 1),    UNARY(atan, -4, 4),     UNARY(sinh, -90, 90), UNARY(cosh, -90, 90),
    UNARY(tanh, -10, 10),  UNARY(asinh, -4, 4),    UNARY(acosh, 1, 4),   UNARY(atanh, -1, 1),
    UNARY(exp, -104, 89),  UNARY(exp2, -150, 128), UNARY(log, 0.5F, 2),  UNARY(log2, 0.5F, 2),
    UNARY(log10, 0.5F, 2),
};

/// Special values, multiples of pi/2, random bits, and random numbers of the range.
std::vector<float> argumentsOf(const UnaryCase& one) {
  std::vector<float> x = numerics::specialFloats();
  const std::vector<float> hard = numerics::nearMultiplesOfHalfPi(200, 500);
  x.insert(x.end(), hard.begin(), hard.end());
  std::mt19937 random(1);
  std::uniform_real_distribution<float> inRange(one.low, one.high), nearZero(-1e-2F, 1e-2F);
  for (int i = 0; i < 8000; ++i) {
    x.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
    x.push_back(inRange(random));
    x.push_back(nearZero(random));
  }
  return x;
}

TEST_CASE("functions of one float against MPFR") {
  FunctionOracle oracle;
  for (const UnaryCase& one : unaryCases) {
    const std::vector<float> x = argumentsOf(one);
    const std::vector<float> results = one.compute(x);
    Worst worst;
    for (std::size_t i = 0; i < x.size(); ++i)
      worst.add(oracle.error(one.exact, x[i], results[i]), results[i], x[i]);
    INFO(one.name << ": " << worst.error << " ulp: " << worst.where);
    CHECK(worst.error <= bound);
  }
}

/// In units in the last place of a float.
double errorOf(float result, double exact) {
  const auto nearest = static_cast<float>(exact);
  if (std::isnan(nearest) || std::isnan(result) || std::isinf(nearest) || std::isinf(result))
    return std::isnan(nearest) ? (std::isnan(result) ? 0 : HUGE_VAL) : result == nearest ? 0 : HUGE_VAL;
  const int exponent = exact == 0 ? -126 : std::max(std::ilogb(exact), -126);
  return std::ldexp(std::fabs(result - exact), 23 - exponent);
}

TEST_CASE("functions of one float, swept over all of them") {
  const char* wanted = std::getenv("SK_STRIDE");
  const std::uint64_t stride = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 6101;
  REQUIRE(stride > 0);
  for (const UnaryCase& one : unaryCases) {
    Worst worst;
    std::vector<float> x;
    for (std::uint64_t bits = 0; bits < std::uint64_t{1} << 32; bits += stride) {
      x.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      if (x.size() < (1U << 20) && bits + stride < std::uint64_t{1} << 32) continue;
      const std::vector<float> results = one.compute(x);
      for (std::size_t i = 0; i < x.size(); ++i)
        worst.add(errorOf(results[i], one.nearlyExact(x[i])), results[i], x[i]);
      x.clear();
    }
    if (wanted != nullptr) std::cout << one.name << " " << worst.error << " " << worst.where << "\n";
    INFO(one.name << ": " << worst.error << " ulp: " << worst.where);
    CHECK(worst.error <= bound);
  }
}

struct BinaryCase {
  const char* name;
  std::vector<float> (*compute)(const std::vector<float>&, const std::vector<float>&);
  numerics::Binary exact;
  double bound;
};

#define BINARY(f, exact, bound)                                        \
  BinaryCase {                                                         \
    #f,                                                                \
        [](const std::vector<float>& x, const std::vector<float>& y) { \
          return computed(functions::of_##f, x, y);                    \
        },                                                             \
        exact, bound                                                   \
  }

const BinaryCase binaryCases[] = {
    BINARY(pow, mpfr_pow, bound), BINARY(atan, mpfr_atan2, bound),         BINARY(atan2, mpfr_atan2, bound),
    BINARY(fmod, mpfr_fmod, 0),   BINARY(mod, numerics::floorModulo, 0.5),
};

/// All pairs of special values, and random ones: of any bits, near by, whole, and for powers near 1 and of moderate size.
void argumentPairs(std::vector<float>& x, std::vector<float>& y) {
  const auto add = [&](float a, float b) {
    x.push_back(a);
    y.push_back(b);
  };
  for (const float a : numerics::specialFloats()) {
    for (const float b : numerics::specialFloats()) add(a, b);
  }
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  std::uniform_int_distribution<int> whole(-20, 20);
  for (int i = 0; i < 5000; ++i) {
    const auto bits = static_cast<std::uint32_t>(random());
    add(std::bit_cast<float>(bits), std::bit_cast<float>(static_cast<std::uint32_t>(random())));
    add(std::bit_cast<float>(bits), std::bit_cast<float>(bits + (static_cast<std::uint32_t>(random()) >> 5)));
    add(std::exp(14 * unit(random) - 7), 24 * unit(random) - 12);
    add(0.99F + 0.02F * unit(random), 16000 * unit(random) - 8000);
    add(static_cast<float>(whole(random)), static_cast<float>(whole(random)));
    add(2000 * unit(random) - 1000, 4 * unit(random) - 2);
  }
  // a grid of powers up to the ends of the range
  for (int i = -149; i < 128; i += 3) {
    for (int k = -40; k <= 40; ++k) add(std::ldexp(1 + unit(random), i), static_cast<float>(k) / 8);
  }
}

TEST_CASE("functions of two floats against MPFR") {
  FunctionOracle oracle;
  std::vector<float> x, y;
  argumentPairs(x, y);
  for (const BinaryCase& one : binaryCases) {
    const std::vector<float> results = one.compute(x, y);
    Worst worst;
    for (std::size_t i = 0; i < x.size(); ++i)
      worst.add(oracle.error(one.exact, x[i], y[i], results[i]), results[i], x[i], y[i]);
    INFO(one.name << ": " << worst.error << " ulp: " << worst.where);
    CHECK(worst.error <= one.bound);
  }
}

}  // namespace
