// SPDX-License-Identifier: MIT
//
// Promises: the predicted error of a table is a bound, for smooth functions, peaks, kinks and jumps, whatever the range; it is not much
// larger than errors that occur; a function that samples do not resolve is reported.
#include "device/function_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/native/table.hpp"

namespace {

using sk::Interpolation;
using sk::TableRange;
using Function = double (*)(double x, double a, double b);

/// Each with parameters a, from 1/16 to 256, and b, from 1/16 to 4, of either sign.
const Function functions[] = {
    [](double x, double a, double b) { return std::sin(a * x + b); },
    [](double x, double a, double b) { return std::exp(-std::fabs(a) * std::fabs(x - b)); },
    [](double x, double a, double b) { return std::exp(-std::fabs(a) * (x - b) * (x - b)); },
    [](double x, double a, double b) { return std::fabs(a * x - b); },
    [](double x, double a, double b) { return x < b ? 0 : a; },
    [](double x, double, double b) { return std::cbrt(x - b); },
    [](double x, double a, double b) { return std::sqrt(std::fabs(a * (x - b))); },
    [](double x, double a, double b) { return std::tanh(a * (x - b)); },
    [](double x, double a, double b) { return 1 / (1 + a * a * (x - b) * (x - b)); },
    [](double x, double a, double) { return std::sin(a * x * x); },
    [](double x, double a, double b) { return a * x + b - std::floor(a * x + b); },
    [](double x, double a, double b) { return std::log(1e-3 + std::fabs(a * x + b)); },
    [](double x, double a, double b) { return std::sin(x) + 1e-3 * std::sin(97 * a * x + b); },
    [](double x, double a, double b) { return 1000 + 1e-3 * std::sin(a * x + b); },
};

/// Polynomials through the function's values, with slopes by differences.
std::vector<float> coefficientsOf(const sk::FunctionValues& values, const TableRange& range, bool isCubic) {
  const double width = (double{range.high} - range.low) / range.intervals, h = width / 16;
  std::vector<float> coefficients;
  for (int i = 0; i < range.intervals; ++i) {
    const double low = range.low + width * i, high = low + width;
    const std::vector<double> f = values({low, high, low - h, low + h, high - h, high + h});
    const double rise = f[1] - f[0], from = (f[3] - f[2]) * 8, to = (f[5] - f[4]) * 8;
    std::vector<double> c{f[0], rise};
    if (isCubic) c = {f[0], from, 3 * rise - 2 * from - to, from + to - 2 * rise};
    coefficients.insert(coefficients.end(), c.begin(), c.end());
  }
  return coefficients;
}

struct Outcome {
  sk::InterpolationError predicted;
  double found = 0;  ///< the largest error of some lookups
};

Outcome outcomeOf(const std::function<double(double)>& f, const TableRange& range, bool isCubic,
                  std::mt19937& random) {
  const sk::FunctionValues values = [&](const std::vector<double>& x) {
    std::vector<double> y(x.size());
    std::ranges::transform(x, y.begin(), f);
    return y;
  };
  const std::vector<float> coefficients = coefficientsOf(values, range, isCubic);
  const float perUnit = static_cast<float>(range.intervals / (double{range.high} - range.low));
  const sk::native::Table table{coefficients.data(), range.low, perUnit, range.intervals, isCubic};
  Outcome outcome{sk::interpolationError(
      values, range, isCubic ? Interpolation::Cubic : Interpolation::Linear, coefficients, 0)};
  std::uniform_real_distribution<float> draw(range.low, range.high);
  for (int i = 0; i < 4000; ++i) {
    const float x = std::clamp(draw(random), range.low, range.high);
    outcome.found = std::max(outcome.found, std::fabs(table.at(x) - f(x)));
  }
  return outcome;
}

/// The environment's number, for long runs: SK_RANDOM_TABLES=100000 SK_RANDOM_SEED=7 sk_runtime_test "predicted errors of random tables are bounds".
unsigned askedFor(const char* variable, unsigned otherwise) {
  const char* text = std::getenv(variable);
  return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : otherwise;
}

TEST_CASE("predicted errors of random tables are bounds") {
  std::mt19937 random(askedFor("SK_RANDOM_SEED", 43));
  const unsigned count = askedFor("SK_RANDOM_TABLES", 300);
  const auto unit = [&] { return random() * 0x1p-32; };
  const auto anySign = [&](double x) { return random() % 2 != 0 ? -x : x; };
  for (unsigned i = 0; i < count; ++i) {
    const Function f = functions[random() % std::size(functions)];
    const double a = anySign(std::exp2(12 * unit() - 4)), b = anySign(std::exp2(6 * unit() - 4));
    const double centre = anySign(random() % 2 != 0 ? 2 * unit() : std::exp2(20 * unit() - 10));
    const double size = std::exp2(12 * unit() - 7);
    const TableRange range{static_cast<float>(centre - size), static_cast<float>(centre + size * unit()),
                           static_cast<std::int32_t>(std::exp2(9 * unit()))};
    const Outcome outcome = outcomeOf([&](double x) { return f(x, a, b); }, range, random() % 2 != 0, random);
    INFO(i << ": a " << a << ", b " << b << ", [" << range.low << ", " << range.high << "] in "
           << range.intervals);
    if (!outcome.predicted.unresolved) CHECK(outcome.found <= outcome.predicted.bound);
  }
}

TEST_CASE("periods and peaks between equidistant samples are found") {
  std::mt19937 random(7);
  const auto predicted = [&](const std::function<double(double)>& f, const TableRange& range, double least) {
    const Outcome outcome = outcomeOf(f, range, false, random);
    CHECK_FALSE(outcome.predicted.unresolved);
    CHECK(outcome.found > least);
    CHECK(outcome.predicted.bound >= outcome.found);
    CHECK(outcome.predicted.bound < 2 * outcome.found);
  };
  predicted([](double x) { return std::sin(16 * x); }, {-3.1415927F, 3.1415927F, 2}, 0.9);
  predicted([](double x) { return std::exp(-20 * std::fabs(x)); }, {-8, 8, 3}, 0.8);
  predicted([](double x) { return std::exp(-20 * std::fabs(x)); }, {-8, 8.5F, 2}, 0.8);
  predicted([](double x) { return x < 0.3 ? 0.0 : 1.0; }, {-1, 1, 5}, 0.5);
  predicted([](double x) { return std::sqrt(std::fabs(x)); }, {-1, 1, 5}, 0.1);
  // Its largest error is at a cusp, of which a chord that is continued misses less than that.
  const auto cusp = [](double x) { return std::sqrt(std::fabs(57.5801396 * (x + 1.16397824))); };
  CHECK(outcomeOf(cusp, {-6.06243086F, 11.100359F, 385}, false, random).predicted.bound >= 0.657972);
}

TEST_CASE("what samples do not resolve is reported") {
  std::mt19937 random(7);
  const Outcome outcome = outcomeOf([](double x) { return std::sin(1e9 * x); }, {-4, 4, 2}, false, random);
  REQUIRE(outcome.predicted.unresolved);
  CHECK(outcome.predicted.unresolved->first < outcome.predicted.unresolved->second);
}

}  // namespace
