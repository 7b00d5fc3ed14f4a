// SPDX-License-Identifier: MIT
//
// The intrinsics of floats against <cmath> in double, for every vector width; shared/intrinsics.hpp states the error bounds
// and where they come from.
#include <algorithm>
#include <cmath>

#include "intrinsics.sk.hpp"
#include "shared/intrinsics.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float2, sk::float3, sk::float4;

namespace {

constexpr std::int64_t count = 400;

/// Values in [low, high], including both ends, but on no grid that would suit an argument reduction.
std::vector<float4> spread(double low, double high, std::uint32_t seed) {
  std::vector<float4> result;
  const auto at = [&](std::uint32_t i) {
    const double t = hashed(i + 7777u * seed) / 4294967295.0;
    return static_cast<float>(low + (high - low) * t);
  };
  for (std::uint32_t i = 0; i < count; ++i)
    result.push_back({at(4 * i), at(4 * i + 1), at(4 * i + 2), at(4 * i + 3)});
  result[0] = {float(low), float(high), float(low), float(high)};
  return result;
}

/// The outputs of a kernel for vectors of four widths. Each width gets some of the components of x.
struct Outputs {
  explicit Outputs(sk::Device& device)
      : r(device.stream<float4>({count})),
        r3(device.stream<float3>({count})),
        r2(device.stream<float2>({count})),
        r1(device.stream<float>({count})) {}

  /// "" if every component is within the error bounds of reference(component number, element).
  template <class Reference>
  std::string wrong(const Reference& reference, double absolute, double relative) const {
    const auto check = [&](const char* width, const std::vector<float>& actual, std::vector<int> components) {
      const std::string text = difference(
          actual,
          [&](std::size_t i) { return reference(components[i % components.size()], i / components.size()); },
          absolute, relative);
      return text.empty() ? "" : std::string(width) + ": " + text;
    };
    const auto four = r.read();
    const auto three = r3.read();
    const auto two = r2.read();
    std::vector<float> flat4, flat3, flat2;
    for (const float4& v : four) flat4.insert(flat4.end(), {v.x, v.y, v.z, v.w});
    for (const float3& v : three) flat3.insert(flat3.end(), {v.x, v.y, v.z});
    for (const float2& v : two) flat2.insert(flat2.end(), {v.x, v.y});
    return check("float4", flat4, {0, 1, 2, 3}) + check("float3", flat3, {3, 2, 1}) +
           check("float2", flat2, {1, 0}) + check("float", r1.read(), {2});
  }

  sk::Stream<float4> r;
  sk::Stream<float3> r3;
  sk::Stream<float2> r2;
  sk::Stream<float> r1;
};

double component(const float4& v, int c) {
  return std::array{v.x, v.y, v.z, v.w}[static_cast<std::size_t>(c)];
}

struct Bounds {
  double low, high, absolute, relative;
};

}  // namespace

TEST_CASE("functions of one float") {
  onGlAndNative([](sk::Device& device) {
    Outputs out(device);
    const auto check = [&](const char* name, const auto& kernel, double (*reference)(double),
                           const Bounds& b) {
      if (std::string_view(name) == "normalize") return;  // takes the whole vector: see geometry
      INFO(name);
      const auto x = spread(b.low, b.high, 1);
      kernel(streamOf<float4>(device, x), out.r, out.r3, out.r2, out.r1);
      CHECK(out.wrong([&](int c, std::size_t i) { return reference(component(x[i], c)); }, b.absolute,
                      b.relative) == "");
    };
#define CHECK_UNARY(f, reference, ...) \
  check(#f, intrinsics::unary_##f,     \
        [](double x) {                 \
          (void)x;                     \
          return double(reference);    \
        },                             \
        {__VA_ARGS__});
    UNARY_CASES(CHECK_UNARY)
  });
}

TEST_CASE("functions of two floats, and of a vector and a float") {
  onGlAndNative([](sk::Device& device) {
    Outputs out(device);
    const auto second = spread(0.25, 4, 2);
    const auto ys = streamOf<float4>(device, second);
    std::vector<float> s;
    for (const float4& v : second) s.push_back(v.x);
    const auto ss = streamOf<float>(device, s);
    using Reference = double (*)(double, double);
    const auto check = [&](const char* name, const auto& kernel, Reference reference, const Bounds& b) {
      INFO(name);
      const auto x = spread(b.low, b.high, 3);
      kernel(streamOf<float4>(device, x), ys, out.r, out.r3, out.r2, out.r1);
      CHECK(out.wrong(
                [&](int c, std::size_t i) { return reference(component(x[i], c), component(second[i], c)); },
                b.absolute, b.relative) == "");
    };
    const auto checkScalar = [&](const char* name, const auto& kernel, Reference reference, const Bounds& b) {
      INFO(name << " with a scalar");
      const auto x = spread(b.low, b.high, 3);
      kernel(streamOf<float4>(device, x), ss, out.r, out.r3, out.r2, out.r1);
      CHECK(out.wrong([&](int c, std::size_t i) { return reference(component(x[i], c), s[i]); }, b.absolute,
                      b.relative) == "");
    };
#define CHECK_BINARY(f, reference, ...) \
  check(#f, intrinsics::binary_##f, [](double x, double y) { return double(reference); }, {__VA_ARGS__});
#define CHECK_SCALAR(f, reference, ...)                                                         \
  checkScalar(#f, intrinsics::scalar_##f, [](double x, double y) { return double(reference); }, \
              {__VA_ARGS__});
    BINARY_CASES(CHECK_BINARY)
    BINARY_SCALAR_CASES(CHECK_BINARY)
    BINARY_SCALAR_CASES(CHECK_SCALAR)
  });
}

TEST_CASE("functions of three floats") {
  onGlAndNative([](sk::Device& device) {
    Outputs out(device);
    const auto second = spread(-1, 1, 4), third = spread(1, 3, 5);
    using Reference = double (*)(double, double, double);
    const auto check = [&](const char* name, const auto& kernel, Reference reference, const Bounds& b) {
      INFO(name);
      const auto x = spread(b.low, b.high, 6);
      kernel(streamOf<float4>(device, x), streamOf<float4>(device, second), streamOf<float4>(device, third),
             out.r, out.r3, out.r2, out.r1);
      CHECK(out.wrong(
                [&](int c, std::size_t i) {
                  return reference(component(x[i], c), component(second[i], c), component(third[i], c));
                },
                b.absolute, b.relative) == "");
    };
#define CHECK_TERNARY(f, reference, ...)                                                             \
  check(#f, intrinsics::ternary_##f, [](double x, double y, double z) { return double(reference); }, \
        {__VA_ARGS__});
    TERNARY_CASES(CHECK_TERNARY)
  });
}

TEST_CASE("an intrinsic of a constant is what the device computes") {
  struct Row {
    const char* name;
    double absolute, relative;
  };
#define NAME(f, reference, low, high, ...) {#f, __VA_ARGS__},
  const std::vector<Row> rows = {UNARY_CASES(NAME)};
  std::vector<float> x(rows.size(), 0.625f);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (std::string_view(rows[i].name) == "acosh") x[i] = 1.6f;
  }
  const auto size = static_cast<std::int64_t>(rows.size());
  onGlAndNative([&](sk::Device& device) {
    auto folded = device.stream<float>({size}), computed = device.stream<float>({size});
    intrinsics::constants(streamOf<float>(device, x), folded, computed);
    const auto a = folded.read(), b = computed.read();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      INFO(rows[i].name);
      // The driver may fold what skc does not, with a more accurate libm: the results agree within the row's error.
      CHECK(std::fabs(a[i] - b[i]) <= std::max(rows[i].absolute, rows[i].relative * std::fabs(b[i])));
    }
  });
}

TEST_CASE("small powers are products") {
  const std::vector<float> x = {0,           -0.0f,  1,     -1,     1.1f,  -1.7f,    3.3333f,
                                -12345.678f, 1e-10f, 3e12f, -2e19f, 1e38f, INFINITY, -INFINITY};
  const auto size = static_cast<std::int64_t>(x.size());
  onGlAndNative([&](sk::Device& device) {
    auto square = device.stream<float>({size}), moved = device.stream<float>({size}),
         cube = device.stream<float>({size}), fourth = device.stream<float>({size});
    auto both = device.stream<float2>({size});
    intrinsics::powers(streamOf<float>(device, x), 0.3f, square, moved, cube, fourth, both);
    const auto s = square.read(), m = moved.read(), c = cube.read(), f = fourth.read();
    const auto b = both.read();
    const bool isNative = &device == &run_tests::device("native");
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO("x = " << x[i]);
      const float difference = x[i] - 0.3f;
      CHECK(s[i] == x[i] * x[i]);
      CHECK(m[i] == difference * difference);
      CHECK(b[i].x == s[i]);
      CHECK(b[i].y == s[i]);
      const double exact = double(x[i]) * x[i] * x[i];
      if (isNative) {
        CHECK(c[i] == float(exact));
        CHECK(f[i] == float(exact * x[i]));
      } else if (std::isfinite(float(exact))) {
        CHECK(std::fabs(c[i] - exact) <= 1.5 * 0x1p-23 * std::fabs(exact) + 0x1p-126);
      } else {
        CHECK(c[i] == float(exact));
      }
    }
  });
}
