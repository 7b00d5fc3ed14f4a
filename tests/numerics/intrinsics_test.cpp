// SPDX-License-Identifier: MIT
//
// Promises: accurate intrinsics are within the bounds of sk/error_bounds.def over all floats, 3 ulp at most, with the special cases of
// C99 (annex F), on every profile and natively. The reference is the C library in double, whose error is about 1e-9 ulp of a float.
//
// A device may read denormals as 0, and give 0 for a denormal result. The worst of all arguments are those of exhaustive.json.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "intrinsics.sk.hpp"
#include "sk/error_bounds.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/exhaustive_runs.hpp"
#include "support/values.hpp"

namespace run_tests {
namespace {

using namespace measured;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t side = 256;
constexpr std::size_t count = side * side;

struct Range {
  double low, high;
};

/// Random bits in the first half, values from the ranges in the second, and special values at the end.
std::vector<float> inputs(const std::vector<Range>& ranges, std::uint32_t seed) {
  std::vector<float> x(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t bits = hashed(static_cast<std::uint32_t>(i) + seed * 0x9e3779b9U);
    const Range& range = ranges[i % ranges.size()];
    const double t = bits * 0x1p-32;
    x[i] = i < count / 2 ? std::bit_cast<float>(bits)
                         : static_cast<float>(range.low + (range.high - range.low) * t);
  }
  const float special[] = {0.0F,     -0.0F,  1.0F,    -1.0F,       inf,        -inf,   nan,
                           0.5F,     -0.5F,  2.0F,    8.0F,        1e-38F,     1e10F,  3.4e38F,
                           -3.4e38F, 1e-30F, 1e30F,   88.7F,       -87.3F,     88.73F, -104.0F,
                           127.9F,   128.0F, -149.0F, 0.99999994F, 1.0000001F, 1e-45F, 3000.0F};
  std::ranges::copy(special, x.end() - std::size(special));
  return x;
}

bool isDenormal(double x) { return x != 0 && std::fabs(x) < 0x1p-126; }

/// One unit in the last place of the float nearest to `exact`.
double ulp(double exact) {
  return std::ldexp(1.0, std::max(exact == 0 ? -126 : std::ilogb(exact), -126) - 23);
}

/// The error in ulp; infinite if only one of the two is NaN or infinite.
double ulps(float got, double exact) {
  const auto nearest = static_cast<float>(exact);
  if (std::isnan(nearest) || std::isnan(got)) return std::isnan(nearest) == std::isnan(got) ? 0 : HUGE_VAL;
  if (!std::isinf(nearest) && !std::isinf(got)) return std::fabs(got - exact) / ulp(exact);
  const bool isOverflow = std::fabs(exact) > 3.4028233e38 && std::fabs(got) > 3.4028230e38F;
  return got == nearest ? 0 : isOverflow ? 1 : HUGE_VAL;  // may overflow an ulp early or late
}

/// The largest error over all elements, and its arguments.
struct Worst {
  double error = 0;
  std::string where;

  /// Adds the error of a function that returned `got` for x, and y if it has two arguments.
  void add(double ulps, double got, double exact, float x, float y = 0) {
    if (ulps <= error) return;
    std::ostringstream text;
    text << std::hexfloat << x << ", " << y << ": " << got << ", not " << exact;
    *this = {ulps, text.str()};
  }
};

using Unary = std::function<double(double)>;

Worst worst(sk::Device& device, const auto& kernel, const Unary& exact, const std::vector<float>& x) {
  auto r = device.stream<float>({side, side});
  kernel(streamOf<float>(device, {side, side}, x), r);
  const std::vector<float> got = r.read();
  Worst result;
  const bool mayFlush = device.profile() != "native";
  for (std::size_t i = 0; i < count; ++i) {
    double error = ulps(got[i], exact(x[i]));
    if (mayFlush && isDenormal(x[i])) error = std::min(error, ulps(got[i], exact(std::copysign(0.0, x[i]))));
    if (mayFlush && isDenormal(exact(x[i])) && got[i] == 0) error = 0;
    result.add(error, got[i], exact(x[i]), x[i]);
  }
  return result;
}

struct Case {
  const char* name;
  std::function<Worst(sk::Device&, const std::vector<float>&)> measure;
  std::vector<Range> ranges;  ///< ranges that are hard to compute
};

#define MEASURED(f, exact, ...)                                                 \
  Case {                                                                        \
    #f,                                                                         \
        [](sk::Device& device, const std::vector<float>& values) {              \
          return worst(device, of_##f, [](double x) { return exact; }, values); \
        },                                                                      \
    {                                                                           \
      __VA_ARGS__                                                               \
    }                                                                           \
  }

// clang-format off
const Case cases[] = {
    MEASURED(sin, std::sin(x), {-4, 4}, {-3000, 3000}, {3000, 1e7}, {6.2831845, 6.2831862}, {1e10, 3.4e38}),
    MEASURED(cos, std::cos(x), {-4, 4}, {-3000, 3000}, {3000, 1e7}, {1.5707960, 1.5707968}, {1e10, 3.4e38}),
    MEASURED(tan, std::tan(x), {-4, 4}, {-3000, 3000}, {3000, 1e7}, {1.5707960, 1.5707968}, {1e10, 3.4e38}),
    MEASURED(asin, std::asin(x), {-1, 1}, {0.49, 0.51}, {0.999, 1}, {-1e-3, 1e-3}),
    MEASURED(acos, std::acos(x), {-1, 1}, {0.49, 0.51}, {0.999, 1}, {-1e-3, 1e-3}),
    MEASURED(atan, std::atan(x), {-10, 10}, {0.9, 1.1}, {-1e-3, 1e-3}, {100, 1e8}),
    MEASURED(sinh, std::sinh(x), {-90, 90}, {-2, 2}, {88, 89.5}, {-1e-3, 1e-3}),
    MEASURED(cosh, std::cosh(x), {-90, 90}, {-2, 2}, {88, 89.5}, {-1e-3, 1e-3}),
    MEASURED(tanh, std::tanh(x), {-10, 10}, {-1, 1}, {8, 10}, {-1e-3, 1e-3}),
    MEASURED(asinh, std::asinh(x), {-10, 10}, {0.9, 1.2}, {1e8, 1e10}, {-1e-3, 1e-3}),
    MEASURED(acosh, std::acosh(x), {1, 10}, {1, 1.0001}, {1.4, 1.6}, {1e8, 1e10}),
    MEASURED(atanh, std::atanh(x), {-1, 1}, {0.45, 0.55}, {0.999, 1}, {-1e-3, 1e-3}),
    MEASURED(exp, std::exp(x), {-1, 1}, {-104, 89}, {88.7, 88.73}, {-88, -86}),
    MEASURED(exp2, std::exp2(x), {-1, 1}, {-150, 128}, {127, 128}, {-127, -125}),
    MEASURED(log, std::log(x), {0, 10}, {0.99, 1.01}, {0.9999, 1.0001}, {0.70, 0.72}),
    MEASURED(log2, std::log2(x), {0, 10}, {0.99, 1.01}, {0.9999, 1.0001}, {0.70, 0.72}),
    MEASURED(log10, std::log10(x), {0, 10}, {0.99, 1.01}, {0.9999, 1.0001}, {0.70, 0.72}),
    MEASURED(log1p, std::log1p(x), {-1, 10}, {-0.5, 0.5}, {-1e-3, 1e-3}, {-1, -0.999}, {-0.3, -0.28}, {0.4, 0.43}),
    MEASURED(expm1, std::expm1(x), {-1, 1}, {-104, 89}, {88.7, 88.73}, {-1e-3, 1e-3}, {28, 32}, {-0.4, 0.4}),
    MEASURED(cbrt, std::cbrt(x), {-10, 10}, {0.49, 4.01}, {1e-39, 1e-37}, {-1e30, 1e30}),
    MEASURED(erf, std::erf(x), {-4, 4}, {-0.6, 0.6}, {0.49, 0.51}, {-1e-3, 1e-3}),
    MEASURED(erfc, std::erfc(x), {-4, 10}, {-0.6, 0.6}, {0.49, 0.51}, {9, 10.2}, {0.24, 0.26}),
    MEASURED(sqrt, std::sqrt(x), {0, 10}, {1e30, 3e38}),
    MEASURED(inversesqrt, 1 / std::sqrt(x), {0, 10}, {1e30, 3e38}),
    MEASURED(radians, x * 0.017453292519943295, {-400, 400}),
    MEASURED(degrees, x * 57.295779513082321, {-10, 10}),
};
// clang-format on

/// The bound in ulp on a device, of error_bounds.def. GL's own roots have those of ARB_shader_precision, and keep them with room here.
double boundOf(const std::string& function, const sk::Device& device) {
  const bool isNative = device.profile() == "native";
  const sk::ErrorBound* bound = sk::errorBoundOf(function, sk::BoundedType::Float,
                                                 isNative ? sk::BoundedCode::Native : sk::BoundedCode::Glsl);
  if (bound != nullptr) return bound->bound;
  REQUIRE((function == "sqrt" || function == "inversesqrt"));
  return 2;
}

TEST_CASE("functions of one float, over all of them") {
  for (const Case& one : cases) {
    const std::vector<float> x = inputs(one.ranges, static_cast<std::uint32_t>(&one - cases) + 1);
    onEveryTarget([&](sk::Device& device) {
      const Worst error = one.measure(device, x);
      INFO(one.name << ": " << error.error << " ulp: " << error.where);
      CHECK(error.error <= boundOf(one.name, device));
    });
  }
}

TEST_CASE("the worst arguments of all floats") {
  const std::vector<numerics::ExhaustiveRun> runs = numerics::exhaustiveRuns();
  for (const Case& one : cases) {
    std::vector<float> x(count, 1.0F);
    std::size_t used = 0;
    double recorded = 0;  // natively, where bits are the same on every CPU
    for (const numerics::ExhaustiveRun& run : runs) {
      if (run.function != one.name) continue;
      for (const numerics::ExhaustiveCase& worst : run.worst) x[used++] = worst.x;
      if (run.profile == "native") recorded = run.largest;
    }
    if (used == 0) continue;
    onEveryTarget([&](sk::Device& device) {
      const Worst error = one.measure(device, x);
      INFO(one.name << ": " << error.error << " ulp: " << error.where);
      CHECK(error.error <= boundOf(one.name, device));
      if (device.profile() == "native" && recorded > 0.5)
        CHECK(error.error == Approx(recorded).epsilon(1e-7));
    });
  }
}

TEST_CASE("bounds for all arguments are those of the runs over all arguments") {
  const std::vector<numerics::ExhaustiveRun> runs = numerics::exhaustiveRuns();
  for (const sk::ErrorBound& bound : sk::errorBounds) {
    if (bound.known != sk::KnownBy::AllArguments) continue;
    double largest = 0;
    for (const numerics::ExhaustiveRun& run : runs) {
      const bool isNative = run.profile == "native";
      if (run.function != bound.function || isNative != (bound.code == sk::BoundedCode::Native)) continue;
      INFO(run.function << " " << run.profile);
      CHECK(run.arguments == std::uint64_t{1} << 32);
      CHECK(run.largest <= bound.bound);
      largest = std::max(largest, run.largest);
    }
    INFO(bound.function);
    CHECK(bound.seen == Approx(largest).epsilon(1e-5));
  }
}

using Binary = std::function<double(double, double)>;

Worst worst(sk::Device& device, const auto& kernel, const Binary& exact, const std::vector<float>& x,
            const std::vector<float>& y) {
  auto r = device.stream<float>({side, side});
  kernel(streamOf<float>(device, {side, side}, x), streamOf<float>(device, {side, side}, y), r);
  const std::vector<float> got = r.read();
  Worst result;
  const bool mayFlush = device.profile() != "native";
  for (std::size_t i = 0; i < count; ++i) {
    const double wanted = exact(x[i], y[i]);
    if (mayFlush && (isDenormal(x[i]) || isDenormal(y[i]) || (isDenormal(wanted) && got[i] == 0))) continue;
    result.add(ulps(got[i], wanted), got[i], wanted, x[i], y[i]);
  }
  return result;
}

struct Pairs {
  const char* name;
  std::vector<float> x, y;
};

/// Pairs of random bits, and of values from the ranges.
Pairs pairs(const char* name, std::vector<Range> x, std::vector<Range> y, std::uint32_t seed) {
  Pairs made{name, inputs(x, seed), inputs(y, seed + 100)};
  std::ranges::rotate(made.y, made.y.end() - 3);  // combines special values with other special values
  return made;
}

TEST_CASE("powers and angles, over all pairs of floats") {
  const std::vector<Pairs> all = {pairs("wide", {{1e-3, 1e3}}, {{-12, 12}}, 31),
                                  pairs("near 1", {{0.99, 1.01}}, {{-8000, 8000}}, 32),
                                  pairs("whole", {{-20, 20}}, {{-3, 3}}, 33)};
  for (const Pairs& one : all) {
    onEveryTarget([&](sk::Device& device) {
      const Worst power =
          worst(device, of_pow, [](double a, double b) { return std::pow(a, b); }, one.x, one.y);
      INFO(one.name << ": pow " << power.error << " ulp: " << power.where);
      CHECK(power.error <= boundOf("pow", device));
      const Worst angle =
          worst(device, of_atan2, [](double a, double b) { return std::atan2(a, b); }, one.x, one.y);
      INFO(one.name << ": atan2 " << angle.error << " ulp: " << angle.where);
      CHECK(angle.error <= boundOf("atan2", device));
      const Worst length =
          worst(device, of_hypot, [](double a, double b) { return std::hypot(a, b); }, one.x, one.y);
      INFO(one.name << ": hypot " << length.error << " ulp: " << length.where);
      CHECK(length.error <= boundOf("hypot", device));
      const Worst left =
          worst(device, of_fmod, [](double a, double b) { return std::fmod(a, b); }, one.x, one.y);
      INFO(one.name << ": fmod " << left.error << " ulp: " << left.where);
      CHECK(left.error <= boundOf("fmod", device));
    });
  }
}

TEST_CASE("the special cases of C99") {
  std::vector<float> x, y;
  const float special[] = {0.0F, -0.0F, 1.0F, -1.0F, 2.0F, -2.0F, 0.5F,        -0.5F,
                           3.0F, -3.0F, inf,  -inf,  nan,  1e30F, 16777217.0F, 8388609.0F};
  for (const float a : special) {
    for (const float b : special) {
      x.push_back(a);
      y.push_back(b);
    }
  }
  onEveryTarget([&](sk::Device& device) {
    const auto n = static_cast<std::int64_t>(x.size());
    auto power = device.stream<float>({n});
    auto angle = device.stream<float>({n});
    auto left = device.stream<float>({n});
    auto modulo = device.stream<float>({n});
    auto length = device.stream<float>({n});
    of_pow(streamOf<float>(device, x), streamOf<float>(device, y), power);
    of_atan2(streamOf<float>(device, x), streamOf<float>(device, y), angle);
    of_fmod(streamOf<float>(device, x), streamOf<float>(device, y), left);
    of_mod(streamOf<float>(device, x), streamOf<float>(device, y), modulo);
    of_hypot(streamOf<float>(device, x), streamOf<float>(device, y), length);
    const auto p = power.read();
    const auto a = angle.read();
    const auto l = left.read();
    const auto m = modulo.read();
    const auto h = length.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i] << ", " << y[i]);
      CHECK(ulps(p[i], std::pow(double{x[i]}, double{y[i]})) <= 1.5);
      if (!std::isnan(p[i])) CHECK(std::signbit(p[i]) == std::signbit(std::pow(x[i], y[i])));
      CHECK(ulps(a[i], std::atan2(double{x[i]}, double{y[i]})) <= 2.3);
      if (!std::isnan(a[i])) CHECK(std::signbit(a[i]) == std::signbit(std::atan2(x[i], y[i])));
      CHECK(isSame(l[i], std::fmod(x[i], y[i])));
      CHECK(ulps(h[i], std::hypot(double{x[i]}, double{y[i]})) <= boundOf("hypot", device));
      const float wanted = l[i] != 0 && (l[i] < 0) != (y[i] < 0) ? l[i] + y[i] : l[i];
      CHECK(isSame(m[i], wanted));
    }
  });
}

TEST_CASE("zeros keep their sign") {
  const std::vector<float> x(side * side, -0.0F);
  onEveryTarget([&](sk::Device& device) {
    const auto in = streamOf<float>(device, {side, side}, x);
    auto r = device.stream<float>({side, side});
    const auto keepsSign = [&](const auto& kernel) {
      kernel(in, r);
      return std::signbit(r.read()[0]) && r.read()[0] == 0;
    };
    CHECK(keepsSign(of_sin));
    CHECK(keepsSign(of_tan));
    CHECK(keepsSign(of_asin));
    CHECK(keepsSign(of_atan));
    CHECK(keepsSign(of_sinh));
    CHECK(keepsSign(of_tanh));
    CHECK(keepsSign(of_asinh));
    CHECK(keepsSign(of_log1p));
    CHECK(keepsSign(of_expm1));
    CHECK(keepsSign(of_cbrt));
    CHECK(keepsSign(of_erf));
    CHECK(keepsSign(of_atanh));
  });
}

TEST_CASE("hypotenuses overflow only where they are beyond the largest float") {
  const std::vector<float> x{3e38F, 3e38F, 2.4e38F, 1e-30F, 3e-38F, 1e30F, inf, -inf, nan, 3.4028235e38F};
  const std::vector<float> y{3e38F, 1.5e38F, 2.4e38F, 1e-30F, -4e-38F, 1e-30F, nan, 1.0F, 1.0F, 1e30F};
  onEveryTarget([&](sk::Device& device) {
    const auto n = static_cast<std::int64_t>(x.size());
    auto r = device.stream<float>({n});
    of_hypot(streamOf<float>(device, x), streamOf<float>(device, y), r);
    const std::vector<float> got = r.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i] << ", " << y[i] << ": " << got[i]);
      CHECK(ulps(got[i], std::hypot(double{x[i]}, double{y[i]})) <= boundOf("hypot", device));
    }
    CHECK(got[0] == inf);
    CHECK(got[6] == inf);
  });
}

TEST_CASE("lengths of all vectors") {
  std::vector<sk::float3> v;
  const double scales[] = {1, 1e30, 1e-30, 1e18, 1e-18, 3e37, 1e-37};
  for (std::uint32_t i = 0; i < 7 * 512; ++i) {
    const auto part = [&](std::uint32_t k) {
      return static_cast<float>((hashed(3 * i + k) * 0x1p-32 * 2 - 1) * scales[i % 7]);
    };
    v.push_back({part(0), part(1), part(2)});
  }
  onEveryTarget([&](sk::Device& device) {
    const auto n = static_cast<std::int64_t>(v.size());
    auto l = device.stream<float>({n});
    auto d = device.stream<float>({n});
    auto u = device.stream<sk::float3>({n});
    lengths(streamOf<sk::float3>(device, v), l, d, u);
    const auto gotLengths = l.read();
    const auto gotDistances = d.read();
    const auto gotUnits = u.read();
    Worst length, unit;
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (isDenormal(v[i].x) || isDenormal(v[i].y) || isDenormal(v[i].z)) continue;
      const double exact = std::hypot(double{v[i].x}, double{v[i].y}, double{v[i].z});
      length.add(ulps(gotLengths[i], exact), gotLengths[i], exact, v[i].x);
      length.add(ulps(gotDistances[i], exact), gotDistances[i], exact, v[i].x);
      unit.add(ulps(gotUnits[i].x, v[i].x / exact), gotUnits[i].x, v[i].x / exact, v[i].x);
    }
    const auto bound = [](const char* function) {
      return sk::errorBoundOf(function, sk::BoundedType::Float, sk::BoundedCode::Glsl)->bound;
    };
    CHECK(length.error <= bound("length"));
    CHECK(unit.error <= bound("normalize"));
  });
}

TEST_CASE("vectors, functions of two results and reductions call the same functions") {
  const std::vector<sk::float4> x{{0.1F, 20.0F, -3.0F, 88.0F}, {1e8F, 1e-3F, 0.5F, -100.0F}};
  const std::vector<float> y{1.5F, -2.5F, 3.25F, 0.001F};
  onEveryTarget([&](sk::Device& device) {
    auto e = device.stream<sk::float4>({2});
    auto s = device.stream<sk::float3>({2});
    auto c = device.stream<sk::float2>({2});
    measured::pairs(streamOf<sk::float4>(device, x), e, s, c);
    CHECK(ulps(e.read()[0].w, std::exp(88.0)) <= 1.3);
    CHECK(ulps(e.read()[1].x, std::sin(1e8)) <= 1.7);
    CHECK(ulps(c.read()[1].x, std::cos(1e8)) <= 1.7);
    CHECK(ulps(s.read()[0].y, std::pow(20.0, 20.0)) <= 1.5);
    double sum = 0;
    for (const float value : y) sum += std::pow(std::fabs(double{value}), 3.5);
    CHECK(std::fabs(norm(streamOf<float>(device, y), 3.5F) - sum) <= 4 * 0x1p-23 * sum);
    CHECK(longest(streamOf<sk::float2>(device, {{3, 4}, {0, 0}, {-6, 8}})) == 10.0F);
    CHECK(least(streamOf<float>(device, {nan, 2.0F, -1.0F, nan})) == -1.0F);
  });
}

TEST_CASE("a call may ask for the device's own functions") {
  const std::vector<float> x{0.5F, 1.0F, 2.0F, 3.0F};
  onEveryTarget([&](sk::Device& device) {
    const auto in = streamOf<float>(device, x);
    auto r = device.stream<float>({4});
    of_exp.with({.intrinsics = sk::Intrinsics::Fast})(in, r);
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(std::fabs(r.read()[i] / std::exp(x[i]) - 1) <= 1e-4);
    of_exp.with({.intrinsics = sk::Intrinsics::Accurate})(in, r);
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(ulps(r.read()[i], std::exp(double{x[i]})) <= 1.3);
    const float sum = norm.with({.intrinsics = sk::Intrinsics::Fast})(in, 2.0F);
    CHECK(std::fabs(sum - 14.25F) <= 0.01F);
  });
}

}  // namespace
}  // namespace run_tests
