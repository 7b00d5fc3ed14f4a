// SPDX-License-Identifier: MIT
//
// Promises: the functions that native code calls for intrinsics (compiler/native/library) are within their error bounds over
// all numbers, fmod of floats is exact, and special cases are those of C99, annex F. The reference is MPFR.
//
// The bounds are those of sk/error_bounds.def: for floats 0.5 ulp for rounding to float, and 0.01 ulp at most for the polynomials,
// whose errors float_functions.sk states, and for rounding doubles. exhaustive.json has the worst arguments.
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <catch2/catch.hpp>

#include "native_functions.sk.hpp"
#include "sk/error_bounds.hpp"
#include "sk/sk.hpp"
#include "support/exhaustive_runs.hpp"
#include "support/function_oracle.hpp"

namespace {

using numerics::FunctionOracle;

template <class Real>
double boundOf(std::string_view function) {
  const sk::BoundedType type = std::is_same_v<Real, float> ? sk::BoundedType::Float : sk::BoundedType::Double;
  const sk::ErrorBound* bound = sk::errorBoundOf(function, type, sk::BoundedCode::Native);
  INFO(function);
  REQUIRE(bound != nullptr);
  return bound->bound;
}

template <class Real>
sk::Stream<Real> streamOf(sk::Device& device, const std::vector<Real>& values) {
  auto stream = device.stream<Real>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

template <class Real>
std::vector<Real> computed(const auto& kernel, const std::vector<Real>& x) {
  sk::Device device = sk::Device::native();
  auto result = device.stream<Real>({static_cast<std::int64_t>(x.size())});
  kernel(streamOf(device, x), result);
  return result.read();
}

template <class Real>
std::vector<Real> computed(const auto& kernel, const std::vector<Real>& x, const std::vector<Real>& y) {
  sk::Device device = sk::Device::native();
  auto result = device.stream<Real>({static_cast<std::int64_t>(x.size())});
  kernel(streamOf(device, x), streamOf(device, y), result);
  return result.read();
}

/// The largest error, and its arguments.
struct Worst {
  double error = 0;
  std::string where;

  void add(double ulps, double result, double x, double y = 0) {
    if (!(ulps > error)) return;
    std::ostringstream text;
    text << std::hexfloat << result << " of " << x << ", " << y;
    *this = {ulps, text.str()};
  }
};

template <class Real>
struct UnaryCase {
  const char* name;
  std::vector<Real> (*compute)(const std::vector<Real>&);
  numerics::Unary exact;
  double (*inDouble)(double);
  Real low, high;  ///< the range of most of the random arguments
};

#define UNARY(f, low, high)                                                                  \
  UnaryCase<Real> {                                                                          \
    #f, [](const std::vector<Real>& x) { return computed(functions::of_##f, x); }, mpfr_##f, \
        [](double x) { return std::f(x); }, low, high                                        \
  }

// clang-format off
template <class Real>
const UnaryCase<Real> unaryCases[] = {
    UNARY(sin, -10, 10),
    UNARY(cos, -10, 10),
    UNARY(tan, -10, 10),
    UNARY(asin, -1, 1),
    UNARY(acos, -1, 1),
    UNARY(atan, -4, 4),
    UNARY(sinh, -30, 30),
    UNARY(cosh, -30, 30),
    UNARY(tanh, -10, 10),
    UNARY(asinh, -4, 4),
    UNARY(acosh, 1, 4),
    UNARY(atanh, -1, 1),
    UNARY(exp, -104, 89),
    UNARY(exp2, -150, 128),
    UNARY(log, 0.5F, 2),
    UNARY(log2, 0.5F, 2),
    UNARY(log10, 0.5F, 2),
    UNARY(log1p, -1, 2),
    UNARY(expm1, -2, 2),
    UNARY(cbrt, 0.5F, 8),
    UNARY(erf, -4, 4),
    UNARY(erfc, -4, 28),
};
// clang-format on

template <class Real>
Real anyBits(std::mt19937_64& random) {
  using Bits = std::conditional_t<std::is_same_v<Real, float>, std::uint32_t, std::uint64_t>;
  return std::bit_cast<Real>(static_cast<Bits>(random()));
}

/// Special numbers, numbers near multiples of pi/2, random bits, and random numbers in the case's range and near 0 and 1.
template <class Real>
std::vector<Real> argumentsOf(const UnaryCase<Real>& one) {
  std::vector<Real> x = numerics::specialNumbers<Real>();
  for (const numerics::ExhaustiveRun& run : numerics::exhaustiveRuns()) {
    if (run.function != one.name) continue;
    for (const numerics::ExhaustiveCase& worst : run.worst) x.push_back(worst.x);
  }
  const std::vector<Real> hard = numerics::nearMultiplesOfHalfPi<Real>(200, 500);
  x.insert(x.end(), hard.begin(), hard.end());
  std::mt19937_64 random(1);
  std::uniform_real_distribution<Real> inRange(one.low, one.high), near(-1e-2F, 1e-2F);
  for (int i = 0; i < 5000; ++i) {
    x.push_back(anyBits<Real>(random));
    x.push_back(inRange(random));
    x.push_back(near(random));
    x.push_back(1 + near(random));
  }
  return x;
}

TEMPLATE_TEST_CASE("functions of one number against MPFR", "", float, double) {
  FunctionOracle oracle;
  for (const UnaryCase<TestType>& one : unaryCases<TestType>) {
    const std::vector<TestType> x = argumentsOf(one);
    const std::vector<TestType> results = one.compute(x);
    Worst worst;
    for (std::size_t i = 0; i < x.size(); ++i)
      worst.add(oracle.error(one.exact, x[i], results[i]), results[i], x[i]);
    INFO(one.name << ": " << worst.error << " ulp: " << worst.where);
    CHECK(worst.error <= boundOf<TestType>(one.name));
  }
}

/// The error in ulp of a float.
double errorOf(float result, double exact) {
  const auto nearest = static_cast<float>(exact);
  if (std::isnan(nearest)) return std::isnan(result) ? 0 : HUGE_VAL;
  if (!std::isfinite(nearest) || !std::isfinite(result)) return result == nearest ? 0 : HUGE_VAL;
  const int exponent = exact == 0 ? -126 : std::max(std::ilogb(exact), -126);
  return std::ldexp(std::fabs(result - exact), 23 - exponent);
}

TEST_CASE("functions of one float, swept over all of them") {
  constexpr std::uint64_t stride = 6101;
  for (const UnaryCase<float>& one : unaryCases<float>) {
    Worst worst;
    std::vector<float> x;
    for (std::uint64_t bits = 0; bits < std::uint64_t{1} << 32; bits += stride) {
      x.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      if (x.size() < (1U << 20) && bits + stride < std::uint64_t{1} << 32) continue;
      const std::vector<float> results = one.compute(x);
      for (std::size_t i = 0; i < x.size(); ++i)
        worst.add(errorOf(results[i], one.inDouble(x[i])), results[i], x[i]);
      x.clear();
    }
    INFO(one.name << ": " << worst.error << " ulp: " << worst.where);
    CHECK(worst.error <= boundOf<float>(one.name));
  }
}

template <class Real>
struct BinaryCase {
  const char* name;
  std::vector<Real> (*compute)(const std::vector<Real>&, const std::vector<Real>&);
  numerics::Binary exact;
};

#define BINARY(Real, f, exact)                                       \
  BinaryCase<Real> {                                                 \
    #f,                                                              \
        [](const std::vector<Real>& x, const std::vector<Real>& y) { \
          return computed(functions::of_##f, x, y);                  \
        },                                                           \
        exact                                                        \
  }

template <class Real>
const std::vector<BinaryCase<Real>> binaryCases = {};
template <>
const std::vector<BinaryCase<float>> binaryCases<float> = {
    BINARY(float, hypot, mpfr_hypot), BINARY(float, pow, mpfr_pow),
    BINARY(float, atan, mpfr_atan2),  BINARY(float, atan2, mpfr_atan2),
    BINARY(float, fmod, mpfr_fmod),   BINARY(float, mod, numerics::floorModulo),
};
template <>
const std::vector<BinaryCase<double>> binaryCases<double> = {
    BINARY(double, hypot, mpfr_hypot),
    BINARY(double, pow, mpfr_pow),
    BINARY(double, atan, mpfr_atan2),
    BINARY(double, atan2, mpfr_atan2),
};

/// All pairs of special numbers, and random pairs: any bits, close together, whole, and for powers near 1 and of moderate size.
template <class Real>
void argumentPairs(std::vector<Real>& x, std::vector<Real>& y) {
  const auto add = [&](Real a, Real b) {
    x.push_back(a);
    y.push_back(b);
  };
  for (const Real a : numerics::specialNumbers<Real>()) {
    for (const Real b : numerics::specialNumbers<Real>()) add(a, b);
  }
  std::mt19937_64 random(2);
  std::uniform_real_distribution<Real> unit(0, 1);
  std::uniform_int_distribution<int> whole(-20, 20);
  for (int i = 0; i < 4000; ++i) {
    const Real any = anyBits<Real>(random);
    add(any, anyBits<Real>(random));
    add(any, any * std::exp(6 * unit(random) - 3));
    add(std::exp(14 * unit(random) - 7), 24 * unit(random) - 12);
    add(Real(0.99) + unit(random) / 50, 16000 * unit(random) - 8000);
    add(1 + unit(random) / (1 << 18), std::ldexp(unit(random) - Real(0.5), 28));
    add(static_cast<Real>(whole(random)), static_cast<Real>(whole(random)));
    add(2000 * unit(random) - 1000, 4 * unit(random) - 2);
  }
  // A grid of powers up to the ends of the range.
  for (int i = -149; i < 128; i += 3) {
    for (int k = -40; k <= 40; ++k) add(std::ldexp(1 + unit(random), i), static_cast<Real>(k) / 8);
  }
}

TEMPLATE_TEST_CASE("functions of two numbers against MPFR", "", float, double) {
  FunctionOracle oracle;
  std::vector<TestType> x, y;
  argumentPairs(x, y);
  for (const BinaryCase<TestType>& one : binaryCases<TestType>) {
    const std::vector<TestType> results = one.compute(x, y);
    Worst worst;
    for (std::size_t i = 0; i < x.size(); ++i)
      worst.add(oracle.error(one.exact, x[i], y[i], results[i]), results[i], x[i], y[i]);
    INFO(one.name << ": " << worst.error << " ulp: " << worst.where);
    CHECK(worst.error <= boundOf<TestType>(one.name == std::string_view("atan") ? "atan2" : one.name));
  }
}

}  // namespace
