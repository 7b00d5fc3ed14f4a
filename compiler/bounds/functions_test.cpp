// SPDX-License-Identifier: MIT
//
// Promises: intervals contain what operations and functions give for numbers within them, and slopes contain difference quotients.
#include "bounds/functions.hpp"

#include <random>

#include <fmt/format.h>
#include <catch2/catch.hpp>

namespace skc::bounds {
namespace {

std::mt19937_64 random_(3);

double between(double low, double high) {
  return std::min(low + (high - low) * std::uniform_real_distribution<double>(0, 1)(random_), high);
}

Interval someInterval(double low, double high) {
  const double a = between(low, high);
  return {a, std::min(a + (high - a) * std::pow(between(0, 1), 4), high)};
}

double exactly(UnaryFunction function, double v) {
  switch (function) {
    case UnaryFunction::Sqrt: return std::sqrt(v);
    case UnaryFunction::InverseSqrt: return 1 / std::sqrt(v);
    case UnaryFunction::Exp: return std::exp(v);
    case UnaryFunction::Exp2: return std::exp2(v);
    case UnaryFunction::Expm1: return std::expm1(v);
    case UnaryFunction::Log: return std::log(v);
    case UnaryFunction::Log2: return std::log2(v);
    case UnaryFunction::Log10: return std::log10(v);
    case UnaryFunction::Log1p: return std::log1p(v);
    case UnaryFunction::Sin: return std::sin(v);
    case UnaryFunction::Cos: return std::cos(v);
    case UnaryFunction::Tan: return std::tan(v);
    case UnaryFunction::Asin: return std::asin(v);
    case UnaryFunction::Acos: return std::acos(v);
    case UnaryFunction::Atan: return std::atan(v);
    case UnaryFunction::Sinh: return std::sinh(v);
    case UnaryFunction::Cosh: return std::cosh(v);
    case UnaryFunction::Tanh: return std::tanh(v);
    case UnaryFunction::Asinh: return std::asinh(v);
    case UnaryFunction::Acosh: return std::acosh(v);
    case UnaryFunction::Atanh: return std::atanh(v);
    case UnaryFunction::Cbrt: return std::cbrt(v);
    case UnaryFunction::Erf: return std::erf(v);
    case UnaryFunction::Erfc: return std::erfc(v);
    case UnaryFunction::Radians: return v * 0.017453292519943295;
    case UnaryFunction::Degrees: return v * 57.29577951308232;
  }
  return 0;
}

TEST_CASE("values and slopes of functions of one number are within their intervals") {
  for (int number = 0; number <= static_cast<int>(UnaryFunction::Degrees); ++number) {
    const auto function = static_cast<UnaryFunction>(number);
    int defined = 0;
    for (int trial = 0; trial < 300; ++trial) {
      const Interval x = someInterval(trial % 2 == 0 ? -3 : 0, trial % 3 == 0 ? 40 : 1.5);
      if (!isDefined(function, x)) continue;
      ++defined;
      const Interval values = valueOf(function, x), slopes = slopeOf(function, x);
      for (int sample = 0; sample < 20; ++sample) {
        const double a = sample == 0 ? x.low : sample == 1 ? x.high : between(x.low, x.high);
        const double b = between(x.low, x.high);
        INFO(fmt::format("{} of {} and {} in {} to {}", spelling(function), a, b, x.low, x.high));
        const double fa = exactly(function, a), fb = exactly(function, b);
        CHECK((values.low <= fa && fa <= values.high));
        if (std::fabs(a - b) < 1e-3 * (1 + std::fabs(a))) continue;
        const double slope = (fa - fb) / (a - b), slack = 1e-9 * (1 + std::fabs(slope));
        CHECK((slopes.low - slack <= slope && slope <= slopes.high + slack));
      }
    }
    CHECK(defined > 20);
  }
}

TEST_CASE("values of functions of two numbers are within their intervals") {
  const auto exact = [](BinaryFunction function, double a, double b) {
    return function == BinaryFunction::Pow     ? std::pow(a, b)
           : function == BinaryFunction::Atan2 ? std::atan2(a, b)
                                               : std::hypot(a, b);
  };
  for (const BinaryFunction function : {BinaryFunction::Pow, BinaryFunction::Atan2, BinaryFunction::Hypot}) {
    for (int trial = 0; trial < 600; ++trial) {
      const Interval x = someInterval(-2, 5);
      const Interval y = trial % 3 == 0 ? Interval::point(std::floor(between(-3, 5))) : someInterval(-2, 3);
      if (!isDefined(function, x, y)) continue;
      const Interval values = valueOf(function, x, y);
      const Slopes slopes = slopesOf(function, x, y);
      for (int sample = 0; sample < 20; ++sample) {
        const double a = sample == 0 ? x.low : between(x.low, x.high), c = between(x.low, x.high);
        const double b = sample == 1 ? y.high : between(y.low, y.high);
        const double value = exact(function, a, b);
        INFO(static_cast<int>(function) << " of " << a << ", " << b);
        CHECK((values.low <= value && value <= values.high));
        if (std::fabs(a - c) < 1e-3) continue;
        const double slope = (value - exact(function, c, b)) / (a - c), slack = 1e-8 * (1 + std::fabs(slope));
        CHECK((slopes.x.low - slack <= slope && slope <= slopes.x.high + slack));
      }
    }
  }
}

TEST_CASE("quotients by intervals with 0 are unknown, and angles jump at the negative axis") {
  CHECK(!(Interval{1, 2} / Interval{-1, 1}).isFinite());
  CHECK(!isDefined(BinaryFunction::Atan2, {-1, 1}, {-2, -1}));
  CHECK(isDefined(BinaryFunction::Atan2, {-1, 1}, {1, 2}));
  CHECK(!isDefined(UnaryFunction::Tan, {1.5, 1.6}));
  CHECK((Interval{0, 1} * Interval{0, 1}).low == 0);
  CHECK((Interval{1, 1} - Interval{0, 1}).low == 0);
}

}  // namespace
}  // namespace skc::bounds
