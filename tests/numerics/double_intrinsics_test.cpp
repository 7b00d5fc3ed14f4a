// SPDX-License-Identifier: MIT
//
// Promises: functions of doubles have the error bounds and special cases of docs/accuracy.md in every representation: GLSL's doubles,
// pairs of floats with `precise` and with a uniform, and native code. The reference is the C library in long double, whose
// error is about 1e-3 ulp of a double. Bounds are those of sk/error_bounds.def.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "double_intrinsics.sk.hpp"
#include "sk/error_bounds.hpp"
#include "sk/sk.hpp"
#include "support/double_configs.hpp"
#include "support/values.hpp"

namespace run_tests {
namespace {

using namespace wide;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t side = 128;
constexpr std::size_t count = side * side;

struct Range {
  double low, high;
};

double random01(std::uint32_t i) { return hashed(i) * 0x1p-32 + hashed(i ^ 0x9e3779b9U) * 0x1p-64; }

/// x, truncated to 48 bits, which a pair of floats holds exactly.
double to48(double x) {
  int e = 0;
  const double mantissa = std::frexp(x, &e);
  return std::ldexp(std::trunc(std::ldexp(mantissa, 48)), e - 48);
}

/// A quarter of the inputs have random exponents in the range of the representation; the others are from the ranges.
std::vector<double> inputs(const DoubleConfig& config, const std::vector<Range>& ranges, std::uint32_t seed) {
  const double exponents = config.isNative() ? 1000 : 60;
  std::vector<double> x(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = static_cast<std::uint32_t>(i) + seed * 0x10000U;
    const double t = random01(number);
    const Range& range = ranges[i % ranges.size()];
    x[i] = range.low + (range.high - range.low) * t;
    if (i < count / 4)
      x[i] = (i % 2 ? -1 : 1) * std::exp2(exponents * (2 * t - 1)) * (1 + random01(number ^ 0x5555U));
    if (!config.isNative()) x[i] = to48(x[i]);
  }
  return x;
}

/// Results below smallest() may have an absolute error of leastError().
double smallest(const DoubleConfig& config) { return config.isNative() ? 0x1p-1022 : 0x1p-78; }
double leastError(const DoubleConfig& config) { return config.isNative() ? 0x1p-1022 : 0x1p-124; }
double largest(const DoubleConfig& config) {
  return config.isNative() ? std::numeric_limits<double>::max() : 0x1.fffffcp127;
}

/// The relative error; infinite if only one of the two is NaN or too large for the configuration. Results too small for it have
/// an absolute bound instead.
double errorOf(const DoubleConfig& config, double got, long double exact) {
  if (std::isnan(exact) || std::isnan(got)) return std::isnan(exact) == std::isnan(got) ? 0 : inf;
  const auto size = static_cast<double>(std::fabs(exact));
  if (size >= largest(config))
    return std::fabs(got) >= largest(config) && std::signbit(got) == std::signbit(exact) ? 0 : inf;
  if (size < smallest(config))
    return std::fabs(static_cast<double>(got - exact)) <= leastError(config) ? 0 : inf;
  return static_cast<double>(std::fabs((got - exact) / exact));
}

struct Worst {
  double error = 0;
  std::string where;

  void add(double other, double got, long double exact, double x, double y = 0) {
    if (other <= error) return;
    std::ostringstream text;
    text.precision(20);
    text << x << ", " << y << ": " << got << ", not " << exact;
    *this = {other, text.str()};
  }
};

/// The error in units of 2^-53, as text.
std::string told(const char* name, const Worst& worst) {
  std::ostringstream text;
  text << name << ": " << worst.error * 0x1p53 << " * 2^-53 = 2^" << std::log2(worst.error) << " at "
       << worst.where;
  return text.str();
}

struct Case {
  const char* name;
  std::function<void(const sk::Stream<double>&, sk::Stream<double>&)> run;
  std::function<long double(long double)> exact;
  std::vector<Range> ranges;
};

#define WIDE(f, exact, ...)                                                       \
  Case {                                                                          \
    #f, [](const sk::Stream<double>& x, sk::Stream<double>& r) { of_##f(x, r); }, \
        [](long double x) -> long double { return exact; }, {                     \
      __VA_ARGS__                                                                 \
    }                                                                             \
  }

constexpr long double pi = 3.14159265358979323846264338327950288L;

// clang-format off
const Case cases[] = {
    WIDE(sin, std::sin(x), {-4, 4}, {-3000, 3000}, {-1e6, 1e6}, {3.1415926, 3.1415927}, {1e6, 1e9}, {1e9, 1e38}),
    WIDE(cos, std::cos(x), {-4, 4}, {-3000, 3000}, {-1e6, 1e6}, {1.5707963, 1.5707964}, {1e6, 1e9}, {1e9, 1e38}),
    WIDE(tan, std::tan(x), {-4, 4}, {-3000, 3000}, {-1e6, 1e6}, {1.5707963, 1.5707964}, {1e6, 1e9}, {1e9, 1e38}),
    WIDE(asin, std::asin(x), {-1, 1}, {0.23, 0.24}, {0.999, 1}, {-1e-3, 1e-3}),
    WIDE(acos, std::acos(x), {-1, 1}, {0.23, 0.24}, {0.999, 1}, {-1e-3, 1e-3}),
    WIDE(atan, std::atan(x), {-10, 10}, {0.7, 1.5}, {0.23, 0.24}, {100, 1e8}),
    WIDE(sinh, std::sinh(x), {-88, 88}, {-2, 2}, {-710, 710}, {-1e-3, 1e-3}),
    WIDE(cosh, std::cosh(x), {-88, 88}, {-2, 2}, {-710, 710}, {-1e-3, 1e-3}),
    WIDE(tanh, std::tanh(x), {-20, 20}, {-1, 1}, {0.1, 0.4}, {-1e-3, 1e-3}),
    WIDE(asinh, std::asinh(x), {-10, 10}, {0.3, 0.5}, {1e8, 1e10}, {-1e-3, 1e-3}),
    WIDE(acosh, std::acosh(x), {1, 10}, {1, 1.0001}, {1e8, 1e10}, {1e17, 1e19}),
    WIDE(atanh, std::atanh(x), {-1, 1}, {0.2, 0.5}, {0.999, 1}, {-1e-3, 1e-3}),
    WIDE(exp, std::exp(x), {-1, 1}, {-88, 89}, {-745, 710}, {-1e-3, 1e-3}),
    WIDE(exp2, std::exp2(x), {-1, 1}, {-127, 129}, {-1074, 1024}, {-1e-3, 1e-3}),
    WIDE(log, std::log(x), {0, 10}, {0.99, 1.01}, {0.9999, 1.0001}, {0.70, 0.72}),
    WIDE(log2, std::log2(x), {0, 10}, {0.99, 1.01}, {0.9999, 1.0001}, {0.70, 0.72}),
    WIDE(log10, std::log10(x), {0, 10}, {0.99, 1.01}, {0.9999, 1.0001}, {0.70, 0.72}),
    WIDE(log1p, std::log1p(x), {-1, 10}, {-0.5, 0.5}, {-1, -0.999}, {-1e-3, 1e-3}),
    WIDE(expm1, std::expm1(x), {-1, 1}, {-88, 88}, {-745, 710}, {-1e-3, 1e-3}),
    WIDE(cbrt, std::cbrt(x), {-10, 10}, {0.5, 8}, {1e-20, 1e-18}, {-1e37, 1e37}),
    WIDE(erf, std::erf(x), {-6, 6}, {-1, 1}, {0.74, 0.76}, {-1e-3, 1e-3}),
    WIDE(erfc, std::erfc(x), {-6, 9}, {-1, 1}, {0.74, 0.76}, {8, 27}),
    WIDE(radians, x * (pi / 180), {-400, 400}),
    WIDE(degrees, x * (180 / pi), {-10, 10}),
};
// clang-format on

/// The bound of the relative error. Native bounds are in ulp, which are 2^-53 to 2^-52 of a number.
double boundOf(const DoubleConfig& config, const std::string& function) {
  const bool isOurs = config.profile == "native";
  const sk::ErrorBound* bound =
      sk::errorBoundOf(function, config.isNative() ? sk::BoundedType::Double : sk::BoundedType::Pair,
                       isOurs ? sk::BoundedCode::Native : sk::BoundedCode::Glsl);
  if (bound == nullptr && !config.isNative()) return 0x1p-46;  // radians and degrees: products of pairs
  INFO(function);
  REQUIRE(bound != nullptr);
  return bound->bound * (isOurs ? 0x1p-52 : 0x1p-53);
}

TEST_CASE("functions of one double, over all of them") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig& config) {
    for (const Case& one : cases) {
      const std::vector<double> x = inputs(config, one.ranges, static_cast<std::uint32_t>(&one - cases) + 1);
      auto r = device.stream<double>({side, side});
      one.run(streamOf<double>(device, {side, side}, x), r);
      const std::vector<double> got = r.read();
      Worst worst;
      for (std::size_t i = 0; i < count; ++i) {
        const long double exact = one.exact(x[i]);
        worst.add(errorOf(config, got[i], exact), got[i], exact, x[i]);
      }
      INFO(told(one.name, worst));
      CHECK(worst.error <= boundOf(config, one.name));
    }
  });
}

TEST_CASE("powers and angles") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig& config) {
    const double most = config.isNative() ? 1e300 : 1e37;
    const std::vector<std::pair<Range, Range>> ranges = {
        {{1e-3, 1e3}, {-12, 12}},      {{1e-18, 2e-18}, {1e12, 2e12}}, {{0.5, 2}, {-120, 120}},
        {{0.99, 1.01}, {-8000, 8000}}, {{1, 1.0000001}, {1e6, 1e9}},   {{1, most}, {-1, 1}},
        {{0.6, 0.8}, {-700, 700}}};
    for (const auto& [xs, ys] : ranges) {
      const auto seed = static_cast<std::uint32_t>(&xs - &ranges[0].first) + 40;
      std::vector<double> x = inputs(config, {xs}, seed), y = inputs(config, {ys}, seed + 100);
      auto r = device.stream<double>({side, side}), a = device.stream<double>({side, side});
      const auto in = streamOf<double>(device, {side, side}, x);
      const auto by = streamOf<double>(device, {side, side}, y);
      of_pow(in, by, r);
      of_atan2(in, by, a);
      auto l = device.stream<double>({side, side});
      of_hypot(in, by, l);
      const std::vector<double> powers = r.read(), angles = a.read(), lengths = l.read();
      Worst power, angle, length;
      for (std::size_t i = 0; i < count; ++i) {
        const long double p = std::pow(static_cast<long double>(x[i]), static_cast<long double>(y[i]));
        power.add(errorOf(config, powers[i], p), powers[i], p, x[i], y[i]);
        const long double t = std::atan2(static_cast<long double>(x[i]), static_cast<long double>(y[i]));
        angle.add(errorOf(config, angles[i], t), angles[i], t, x[i], y[i]);
        const long double h = std::hypot(static_cast<long double>(x[i]), static_cast<long double>(y[i]));
        length.add(errorOf(config, lengths[i], h), lengths[i], h, x[i], y[i]);
      }
      INFO(told("pow", power));
      CHECK(power.error <= boundOf(config, "pow"));
      INFO(told("atan2", angle));
      CHECK(angle.error <= boundOf(config, "atan2"));
      INFO(told("hypot", length));
      CHECK(length.error <= boundOf(config, "hypot"));
    }
  });
}

TEST_CASE("the special cases of C99, of doubles") {
  const double special[] = {0.0, -0.0, 1.0, -1.0, 2.0, -2.0, 0.5, -0.5, 3.0, -3.0, 0x1p100, inf, -inf, nan};
  std::vector<double> x, y;
  for (const double a : special) {
    for (const double b : special) {
      x.push_back(a);
      y.push_back(b);
    }
  }
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    const auto n = static_cast<std::int64_t>(x.size());
    const auto in = streamOf<double>(device, x);
    auto r = device.stream<double>({n});
    const auto check = [&](const char* name, const auto& exact) {
      const std::vector<double> got = r.read();
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto wanted = static_cast<double>(exact(x[i], y[i]));
        INFO(name << "(" << x[i] << ", " << y[i] << ") = " << got[i] << ", not " << wanted);
        CHECK(errorOf(config, got[i], wanted) <= 0x1p-44);
        if (!std::isnan(wanted) && std::fabs(wanted) >= smallest(config))
          CHECK(std::signbit(got[i]) == std::signbit(wanted));
        if (wanted == 0) CHECK(std::signbit(got[i]) == std::signbit(wanted));
      }
    };
    of_pow(in, streamOf<double>(device, y), r);
    check("pow", [](double a, double b) { return std::pow(a, b); });
    of_atan2(in, streamOf<double>(device, y), r);
    check("atan2", [](double a, double b) { return std::atan2(a, b); });
    of_hypot(in, streamOf<double>(device, y), r);
    check("hypot", [](double a, double b) { return std::hypot(a, b); });
    of_atan(in, streamOf<double>(device, y), r);
    check("atan of two", [](double a, double b) { return std::atan2(a, b); });
    for (const Case& one : cases) {
      one.run(in, r);
      check(one.name, [&](double a, double) { return one.exact(a); });
    }
  });
}

TEST_CASE("vectors, functions of two results, floats beside doubles, and reductions") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig& config) {
    const double bound = 4 * boundOf(config, "pow");
    const std::vector<sk::double3> x{{0.125, -20, 3}, {1, 2.5, -100}};
    const std::vector<float> f{0.5F, -2.25F};
    auto e = device.stream<sk::double3>({2});
    auto p = device.stream<sk::double2>({2});
    auto g = device.stream<float>({2});
    vectors(streamOf<sk::double3>(device, x), streamOf<float>(device, f), e, p, g);
    const auto es = e.read();
    const auto ps = p.read();
    const auto gs = g.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      CHECK(errorOf(config, es[i].x, std::exp(static_cast<long double>(x[i].x))) <= bound);
      CHECK(errorOf(config, es[i].y, std::exp(static_cast<long double>(x[i].y))) <= bound);
      CHECK(errorOf(config, es[i].z, 1) <= bound);
      CHECK(errorOf(config, ps[i].y, std::pow(std::fabs(static_cast<long double>(x[i].y)), 2.5L)) <= bound);
      CHECK(std::fabs(gs[i] - (std::sin(f[i]) + std::tanh(f[i]))) <= 0x1p-21F);
    }
    const std::vector<double> terms{1.5, 2.25, 1e10, 0.001};
    long double sum = 0;
    for (const double term : terms) sum += std::log(static_cast<long double>(term));
    CHECK(errorOf(config, likelihood(streamOf<double>(device, terms)), sum) <= bound);
  });
}

TEST_CASE("parts of doubles") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig&) {
    std::vector<double> x = {0.0, -0.0, 1.0, -3.75, 0x1p100, -0x1.8p-20, 1234567.875, inf, -inf, nan};
    for (const double more : randomDoubles(500, 3)) x.push_back(more);
    const auto n = static_cast<std::int64_t>(x.size());
    auto m = device.stream<double>({n}), f = device.stream<double>({n}), whole = device.stream<double>({n});
    auto e = device.stream<std::int32_t>({n});
    parts(streamOf<double>(device, x), m, e, f, whole);
    const std::vector<double> mantissas = m.read(), fractions = f.read(), wholes = whole.read();
    const std::vector<std::int32_t> exponents = e.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i]);
      int exponent = 0;
      double part = 0;
      const double mantissa = std::frexp(x[i], &exponent), fraction = std::modf(x[i], &part);
      CHECK(isSame(mantissas[i], mantissa));
      CHECK(exponents[i] == (std::isfinite(x[i]) ? exponent : 0));
      CHECK(isSame(fractions[i], fraction));
      CHECK(isSame(wholes[i], part));
    }
  });
}

TEST_CASE("rays of doubles") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig& config) {
    const double tolerance = config.isNative() ? 0x1p-50 : 0x1p-43;
    const std::vector<sk::double3> i{{0.6, -0.8, 0}, {0, 1, 0}, {0.36, 0.48, -0.8}}, n(3, {0, 1, 0});
    auto mirrored = device.stream<sk::double3>({3}), bent = device.stream<sk::double3>({3}),
         facing = device.stream<sk::double3>({3});
    rays(streamOf<sk::double3>(device, i), streamOf<sk::double3>(device, n), mirrored, bent, facing);
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = i[k].y, root = 1 - 0.5625 * (1 - d * d);
      CHECK(std::fabs(mirrored.read()[k].y + d) <= tolerance);
      CHECK(std::fabs(mirrored.read()[k].x - i[k].x) <= tolerance);
      CHECK(std::fabs(bent.read()[k].x - 0.75 * i[k].x) <= tolerance);
      CHECK(std::fabs(bent.read()[k].y - (0.75 * d - (0.75 * d + std::sqrt(root)))) <= tolerance);
      CHECK(facing.read()[k].y == (d < 0 ? 1 : -1));
    }
  });
}

}  // namespace
}  // namespace run_tests
