// SPDX-License-Identifier: MIT
//
// Doubles in every representation: GLSL's doubles, and pairs of floats with `precise` and with a uniform. Streams hold 64 bits in
// every representation. Native arithmetic is that of IEEE 754. A pair has 48 bits; its sums, products, quotients and roots have
// relative errors below 2^-45: Joldes, Muller and Popescu (2017) bound sums and products by 2^-46.4 and 2^-45.6, and long
// division and one Newton step give quotients and roots.
#include "doubles.sk.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "support/double_configs.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Adds operands that nearly cancel, and operands with long runs of ones and zeros.
void addAdversaries(std::vector<double>& x, std::vector<double>& y) {
  const double ulp = 0x1p-47;
  for (int k = 0; k < 48; ++k) {
    for (const double a : {1.0, 2 - ulp, 1 + ulp, 1 + 0x1p-23, 1 + 0x1p-24, 2 - 0x1p-23, 1.5 - ulp}) {
      for (const double b : {-a, -a + ulp * k, a * std::ldexp(1, -k), 1 - std::ldexp(1, -k - 1) * 0.5,
                             1 + std::ldexp(1, -k)}) {
        if (b == 0) continue;
        x.push_back(a);
        y.push_back(b);
      }
    }
  }
}

/// "" if each element is within `relative` of the expected one.
template <class Expected>
std::string farFrom(const std::vector<double>& actual, const Expected& expected, long double relative) {
  return difference(
      actual, actual.size(), [&](std::size_t i) { return static_cast<double>(expected(i)); },
      [&](double a, double b) {
        return isSame(a, b) || std::fabs(static_cast<long double>(a) - b) <= relative * std::fabs(b);
      });
}

std::string bitsDiffer(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return "sizes differ";
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return std::to_string(i);
  }
  return "";
}

std::vector<double> specials() {
  std::vector<double> list = {0.0,
                              -0.0,
                              1.0,
                              -1.0,
                              infinity,
                              -infinity,
                              5e-324,
                              1e-310,
                              1.7976931348623157e308,
                              std::bit_cast<double>(0x7ff8000000000123ull),
                              std::bit_cast<double>(0xfff0000000000001ull),
                              0.1,
                              1e300,
                              1e-300,
                              16777217.0,
                              9007199254740993.0};
  return list;
}

const std::vector<sk::Shape> shapes = {{0}, {1}, {7}, {1031}, {20000}, {37, 53}, {5, 7, 11}};

}  // namespace

TEST_CASE("streams hold the bits of doubles in every representation") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig&) {
    const std::vector<double> x = specials();
    CHECK(bitsDiffer(streamOf<double>(device, x).read(), x) == "");
    const std::vector<sk::double3> v = {{x[9], x[10], x[6]}, {x[1], x[7], x[8]}};
    const std::vector<sk::double3> read = streamOf<sk::double3>(device, v).read();
    CHECK(std::memcmp(read.data(), v.data(), sizeof(sk::double3) * v.size()) == 0);
  });
}

TEST_CASE("a copy is exact where doubles are native, and of 48 bits in pairs") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig& config) {
    auto r = device.stream<double>({16});
    keep(streamOf<double>(device, specials()), r);
    const std::vector<double> result = r.read();
    if (config.isNative()) {
      CHECK(bitsDiffer(result, specials()) == "");
      return;
    }
    std::vector<double> x = randomDoubles(5000, 1, 75);
    addAdversaries(x, x);
    auto s = device.stream<double>({static_cast<std::int64_t>(x.size())});
    keep(streamOf<double>(device, x), s);
    CHECK(bitsDiffer(s.read(), x) == "");
    CHECK(std::signbit(result[1]));
    CHECK(result[4] == infinity);
    CHECK(result[5] == -infinity);
    CHECK(result[6] == 0);
    CHECK(result[8] == infinity);
    CHECK(std::isnan(result[9]));
    CHECK(std::fabs(result[11] - 0.1) <= 0.1 * 0x1p-48);
    CHECK(std::fabs(result[15] - 9007199254740993.0) <= 64);
  });
}

TEST_CASE("every shape, and vectors") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig& config) {
    for (const sk::Shape& shape : shapes) {
      const auto n = static_cast<std::size_t>(shape.size());
      const std::vector<double> x = randomDoubles(4 * n, 5);
      const auto at = [&](std::size_t i) { return x[i]; };
      std::vector<sk::double2> a(n);
      std::vector<sk::double3> b(n);
      std::vector<sk::double4> c(n);
      for (std::size_t i = 0; i < n; ++i) {
        a[i] = {at(i), at(n + i)};
        b[i] = {at(2 * n + i), at(i), at(3 * n + i)};
        c[i] = {at(4 * i), at(4 * i + 1), at(4 * i + 2), at(4 * i + 3)};
      }
      auto p = device.stream<sk::double2>(shape);
      auto q = device.stream<sk::double3>(shape);
      auto r = device.stream<sk::double4>(shape);
      keepVectors(streamOf<sk::double2>(device, shape, a), streamOf<sk::double3>(device, shape, b),
                  streamOf<sk::double4>(device, shape, c), p, q, r);
      CHECK(p.read() == a);
      CHECK(q.read() == b);
      CHECK(r.read() == c);
      const std::vector<double> u(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n));
      const std::vector<double> v(x.begin() + static_cast<std::ptrdiff_t>(n),
                                  x.begin() + static_cast<std::ptrdiff_t>(2 * n));
      auto s = device.stream<double>(shape);
      saxpy(0.1, streamOf<double>(device, shape, u), streamOf<double>(device, shape, v), s);
      const std::vector<double> sums = s.read();
      for (std::size_t i = 0; i < n; ++i) {
        const double error =
            static_cast<double>(precisionOf(config)) * 3 * (std::fabs(0.1 * u[i]) + std::fabs(v[i]));
        if (std::fabs(sums[i] - (0.1 * u[i] + v[i])) > error) FAIL_CHECK("element " << i);
      }
    }
  });
}

TEST_CASE("arithmetic of doubles keeps its bound") {
  std::vector<double> x = randomDoubles(20000, 11), y = randomDoubles(20000, 12);
  addAdversaries(x, y);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    const auto n = static_cast<std::int64_t>(x.size());
    std::array<sk::Stream<double>, 4> r = {device.stream<double>({n}), device.stream<double>({n}),
                                           device.stream<double>({n}), device.stream<double>({n})};
    arithmetic(streamOf<double>(device, x), streamOf<double>(device, y), r[0], r[1], r[2], r[3]);
    const auto a = [&](std::size_t i) -> long double { return x[i]; };
    const auto b = [&](std::size_t i) -> long double { return y[i]; };
    const long double u = precisionOf(config);
    CHECK(farFrom(r[0].read(), [&](std::size_t i) { return a(i) + b(i); }, u) == "");
    CHECK(farFrom(r[1].read(), [&](std::size_t i) { return a(i) - b(i); }, u) == "");
    CHECK(farFrom(r[2].read(), [&](std::size_t i) { return a(i) * b(i); }, u) == "");
    CHECK(farFrom(r[3].read(), [&](std::size_t i) { return a(i) / b(i); }, u) == "");
    std::vector<double> magnitudes = x;
    for (double& v : magnitudes) v = std::fabs(v);
    roots(streamOf<double>(device, magnitudes), r[0], r[1]);
    // a GPU's own roots of doubles are within a unit in the last place (docs/accuracy.md)
    const bool isRounded = device.isSoftware() || !config.isNative();
    const long double root = isRounded ? u : 2 * u;
    CHECK(farFrom(r[0].read(), [&](std::size_t i) { return std::sqrt(std::fabs(a(i))); }, root) == "");
    CHECK(farFrom(r[1].read(), [&](std::size_t i) { return 1 / std::sqrt(std::fabs(a(i))); }, u + root) == "");
    assigned(streamOf<double>(device, x), r[0]);
    const std::vector<double> s = r[0].read();
    for (std::size_t i = 0; i < s.size(); ++i) {
      // -(t - 1) + t of t = ((x + .1) x - 1) / 3 + 1
      const long double t = ((a(i) + 0.1L) * a(i) - 1) / 3 + 1;
      if (std::fabs(s[i] - 1) > 4 * u * (std::fabs(t) + 1)) FAIL_CHECK("element " << i << " is " << s[i]);
    }
  });
}

TEST_CASE("quotients of small dividends and roots of large numbers keep the bound") {
  std::vector<double> x = randomDoubles(2000, 13), y = randomDoubles(2000, 14);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const int power = 60 + static_cast<int>(i % 65);
    const auto head = static_cast<double>(static_cast<float>(std::ldexp(x[i], -std::ilogb(x[i]) - power)));
    x[i] = head;
    y[i] = std::ldexp(y[i], -std::ilogb(y[i]) - std::clamp(power - 30 + static_cast<int>(i % 50), 0, 70));
  }
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    const auto n = static_cast<std::int64_t>(x.size());
    std::array<sk::Stream<double>, 4> r = {device.stream<double>({n}), device.stream<double>({n}),
                                           device.stream<double>({n}), device.stream<double>({n})};
    arithmetic(streamOf<double>(device, x), streamOf<double>(device, y), r[0], r[1], r[2], r[3]);
    const auto quotient = [&](std::size_t i) { return static_cast<long double>(x[i]) / y[i]; };
    CHECK(farFrom(r[3].read(), quotient, precisionOf(config)) == "");
    const std::vector<double> large = {0x1.fffffep127, 0x1.fffffcp127, 0x1p127, 0x1.fffffep126, 0x1p126};
    auto a = device.stream<double>({5}), b = device.stream<double>({5});
    roots(streamOf<double>(device, large), a, b);
    const auto root = [&](std::size_t i) { return std::sqrt(static_cast<long double>(large[i])); };
    CHECK(farFrom(a.read(), root, precisionOf(config)) == "");
  });
}

TEST_CASE("infinities, NaN and zeros go through arithmetic") {
  const std::vector<double> x = {infinity, infinity, 1, -1, 0, 3e38, infinity, -0.0, 1};
  const std::vector<double> y = {1, -infinity, 0, 0, 0, 3e38, infinity, -0.0, infinity};
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    std::array<sk::Stream<double>, 4> r = {device.stream<double>({9}), device.stream<double>({9}),
                                           device.stream<double>({9}), device.stream<double>({9})};
    arithmetic(streamOf<double>(device, x), streamOf<double>(device, y), r[0], r[1], r[2], r[3]);
    const std::vector<double> total = r[0].read(), product = r[2].read(), quotient = r[3].read();
    CHECK(total[0] == infinity);
    CHECK(std::isnan(total[1]));
    CHECK(total[2] == 1);
    CHECK((config.isNative() ? total[5] == 6e38 : total[5] == infinity));
    CHECK(product[0] == infinity);
    CHECK(product[6] == infinity);
    CHECK(quotient[2] == infinity);
    CHECK(quotient[3] == -infinity);
    CHECK(std::isnan(quotient[4]));
    CHECK(quotient[8] == 0);
  });
}

TEST_CASE("literals take the precision of their place") {
  const std::vector<double> x = randomDoubles(500, 21, 3);
  const std::vector<float> f = values<float>(500);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    auto r0 = device.stream<double>({500}), r1 = device.stream<double>({500}),
         r2 = device.stream<double>({500});
    auto r3 = device.stream<float>({500});
    literals(streamOf<double>(device, x), streamOf<float>(device, f), r0, r1, r2, r3);
    const long double u = precisionOf(config) * 8;
    CHECK(farFrom(r0.read(), [&](std::size_t i) { return 0.1 + (f[i] > 0 ? 0.2 : -0.3); }, u) == "");
    CHECK(farFrom(
              r2.read(),
              [&](std::size_t i) { return double{0.1f} + (static_cast<int>(f[i]) & 1 ? 0.2 : 0.1); },
              u) == "");
    CHECK(difference(r3.read(), [&](std::size_t i) { return f[i] * 0.1f; }) == "");
    const std::vector<double> second = r1.read();
    for (std::size_t i = 0; i < second.size(); ++i) {
      const double wanted = x[i] * 0.1 + 0.6 + 1.0 / 3.0;
      if (std::fabs(second[i] - wanted) > static_cast<double>(u) * (std::fabs(x[i]) + 1))
        FAIL_CHECK("element " << i);
    }
    auto t = device.stream<sk::double2>({500});
    ofTemplates(streamOf<float>(device, f), streamOf<double>(device, x), r3, r0, t);
    CHECK(difference(r3.read(), [&](std::size_t i) { return f[i] * 0.1f + 1.0f / 3.0f; }) == "");
    const auto scaled = r0.read();
    const auto both = t.read();
    for (std::size_t i = 0; i < scaled.size(); ++i) {
      const double error = static_cast<double>(u) * (std::fabs(x[i]) + 1);
      if (std::fabs(scaled[i] - (x[i] * 0.1 + 1.0 / 3.0)) > error) FAIL_CHECK("element " << i);
      if (both[i].x != scaled[i] || std::fabs(both[i].y - (f[i] * 0.1 + 1.0 / 3.0)) > error * 8) {
        FAIL_CHECK("element " << i);
      }
    }
    auto w = device.stream<double>({5});
    table(streamOf<int>(device, {0, 1, 2, 3, 4}), w);
    const std::vector<double> weights = w.read();
    if (config.isNative()) {
      CHECK(bitsDiffer(weights, {0.1, 0.2, 1e300, -0.0, 0x1.fffffffffffffp-3}) == "");
    } else {
      CHECK(std::fabs(weights[0] - 0.1) < 0.1 * 0x1p-47);
      CHECK(weights[2] == infinity);
    }
  });
}

TEST_CASE("integer literals keep their meaning beside doubles") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<sk::double4>({1}), s = device.stream<sk::double4>({1});
    auto t = device.stream<sk::float2>({1});
    integerLiterals(streamOf<double>(device, {2}), streamOf<float>(device, {1}), r, s, t);
    const sk::double4 a = r.read()[0], b = s.read()[0];
    CHECK(a == sk::double4{4294967295.0, 0, 0, 5.25});
    CHECK(!std::signbit(a.y));
    CHECK((b.x == 8589934590.0 && b.y == 3000000002.0 && b.z == 4294967299.0));
    CHECK(std::fabs(b.w - 1 / 3.0) < 1e-13);
    CHECK(t.read()[0] == sk::float2{3e9F, 1});
  });
}

TEST_CASE("doubles become the nearest half, rounded once") {
  // Halfway between two halves and a little more or less, which a float would lose; beyond the largest half; denormals.
  std::vector<double> x;
  for (const double half : {1.0, 1 + 0x1p-10, 1000.5, 65472.0, 0x1p-14, 0x1p-20, 0x1p-24, 0.0}) {
    const double unit = std::ldexp(1.0, std::max(half == 0 ? -14 : std::ilogb(half), -14) - 10);
    for (const double rest : {0.0, 0x1p-30, -0x1p-30, 0x1p-34, -0x1p-34, 0.25, -0.25})
      x.push_back(half + unit * (0.5 + rest));
  }
  x.insert(x.end(), {65519.99999999, 65520.0, 1e10, 1e30, -1e30, 1e-12, infinity, -infinity, std::nan("")});
  const auto nearest = [](double value) {
    if (!(std::fabs(value) < 65520)) return std::isnan(value) ? value : std::copysign(infinity, value);
    const double unit = std::ldexp(1.0, std::max(value == 0 ? -14 : std::ilogb(value), -14) - 10);
    return std::nearbyint(value / unit) * unit;
  };
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    const auto n = static_cast<std::int64_t>(x.size());
    auto r = device.stream<sk::half>({n}), g = device.stream<sk::half>({n});
    auto v = device.stream<sk::half2>({n});
    toHalves(streamOf<double>(device, x), streamOf<float>(device, std::vector<float>(x.size(), 0)), r, v, g);
    const auto one = r.read(), sum = g.read();
    const auto two = v.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i]);
      const auto is = [&](sk::half got, double wanted) {
        return isSame(double{float{got}}, nearest(wanted));
      };
      CHECK(is(one[i], x[i]));
      CHECK(is(sum[i], x[i]));
      CHECK(is(two[i].x, -x[i]));
      CHECK(is(two[i].y, x[i]));
    }
  });
}

TEST_CASE("conversions to and from doubles are exact") {
  std::vector<int> i = {0,         1,     -1,    2147483647, -2147483647 - 1, 16777217,
                        -16777217, 65535, 65536, -65536,     -65537};
  for (std::uint32_t k = 0; k < 2000; ++k) i.push_back(static_cast<int>(hashed(k)));
  std::vector<unsigned> u;
  std::vector<float> f;
  for (const int n : i) u.push_back(static_cast<unsigned>(n));
  for (const unsigned n : u)
    f.push_back(std::isnormal(std::bit_cast<float>(n)) ? std::bit_cast<float>(n) : 1.5f);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    const auto n = static_cast<std::int64_t>(i.size());
    auto a = device.stream<double>({n}), b = device.stream<double>({n}), c = device.stream<double>({n});
    auto d = device.stream<double>({n});
    fromOthers(streamOf<int>(device, i), streamOf<unsigned>(device, u), streamOf<float>(device, f), a, b, c,
               d);
    CHECK(difference(a.read(), [&](std::size_t k) { return static_cast<double>(i[k]); }) == "");
    CHECK(difference(b.read(), [&](std::size_t k) { return static_cast<double>(u[k]); }) == "");
    CHECK(difference(c.read(), [&](std::size_t k) { return double{f[k]}; }) == "");
    CHECK(difference(d.read(), [&](std::size_t k) { return i[k] != 0 ? 1.0 : 0.0; }) == "");
    std::vector<double> x;
    for (const int k : i)
      x.push_back(k + (k > 0 && k < 1 << 20 ? 0.75 : k < 0 && k > -(1 << 20) ? -0.75 : 0));
    auto toInt = device.stream<int>({n});
    auto toUint = device.stream<unsigned>({n});
    auto toFloat = device.stream<float>({n});
    auto toBool = device.stream<bool>({n});
    toOthers(streamOf<double>(device, x), toInt, toUint, toFloat, toBool);
    CHECK(difference(toInt.read(), [&](std::size_t k) { return static_cast<int>(x[k]); }) == "");
    CHECK(difference(toUint.read(), [&](std::size_t k) { return static_cast<unsigned>(std::fabs(x[k])); }) ==
          "");
    CHECK(difference(toFloat.read(), [&](std::size_t k) { return static_cast<float>(x[k]); }) == "");
    auto r = device.stream<float>({n});
    auto s = device.stream<double>({n});
    const std::vector<float> small = values<float>(n);
    const std::vector<double> y = randomDoubles(i.size(), 31, 4);
    mixed(streamOf<float>(device, small), streamOf<double>(device, y), r, s);
    CHECK(difference(r.read(), [&](std::size_t k) { return small[k] * y[k]; }, 0, 0x1p-23) == "");
    const std::vector<double> sums = s.read();
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const double product = small[k] * y[k];
      if (std::fabs(sums[k] - (product + 1)) >
          static_cast<double>(2 * precisionOf(config)) * (std::fabs(product) + 1)) {
        FAIL_CHECK("element " << k);
      }
    }
  });
}

TEST_CASE("comparisons of doubles are exact") {
  std::vector<double> x, y;
  for (const double a :
       {0.0, -0.0, 1.0, 1 + 0x1p-47, 1 - 0x1p-48, -1.0, 16777217.0, infinity, -infinity, std::nan("")}) {
    for (const double b :
         {0.0, 1.0, 1 + 0x1p-47, 1 - 0x1p-48, -1.0, 16777216.0, 16777217.0, infinity, std::nan("")}) {
      x.push_back(a);
      y.push_back(b);
    }
  }
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<int>({static_cast<std::int64_t>(x.size())});
    compared(streamOf<double>(device, x), streamOf<double>(device, y), r);
    CHECK(difference(r.read(), [&](std::size_t i) {
            const double a = x[i], b = y[i];
            return int{a < b} + 2 * int{a <= b} + 4 * int{a > b} + 8 * int{a >= b} + 16 * int{a == b} +
                   32 * int{a != b};
          }) == "");
    const auto n = static_cast<std::int64_t>(x.size());
    auto nan = device.stream<bool>({n}), inf = device.stream<bool>({n}), finite = device.stream<bool>({n});
    classified(streamOf<double>(device, x), nan, inf, finite);
    const auto isNan = nan.read(), isInf = inf.read(), isFinite = finite.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      CHECK((isNan[i] != 0) == std::isnan(x[i]));
      CHECK((isInf[i] != 0) == std::isinf(x[i]));
      CHECK((isFinite[i] != 0) == std::isfinite(x[i]));
    }
  });
}

TEST_CASE("doubles are rounded to integers exactly") {
  std::vector<double> x = {0,          0.5,           1.5,           2.5,           -0.5,        -1.5,
                           -2.5,       0.5 + 0x1p-40, 1.5 - 0x1p-40, 2.5 + 0x1p-40, 1 - 0x1p-48, 3.0,
                           1e9,        1e9 + 0.5,     16777217.5,    8388609.5,     8388608.5,   33554433.5,
                           -8388609.5, -8388610.5,    123456789.25,  -123456789.75, 0x1p47 - 1,  infinity,
                           -infinity};
  for (const double v : randomDoubles(2000, 41, 40)) x.push_back(v);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    const auto n = static_cast<std::int64_t>(x.size());
    auto r = device.stream<Rounded>({n});
    rounded(streamOf<double>(device, x), r);
    const std::vector<Rounded> result = r.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i]);
      CHECK(result[i].low == std::floor(x[i]));
      CHECK(result[i].high == std::ceil(x[i]));
      CHECK(result[i].whole == std::trunc(x[i]));
      CHECK(result[i].even == std::nearbyint(x[i]));
    }
  });
}

TEST_CASE("simple functions of doubles") {
  const std::vector<double> x = randomDoubles(1000, 51, 2), y = randomDoubles(1000, 52, 2);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    std::array<sk::Stream<double>, 4> r = {device.stream<double>({1000}), device.stream<double>({1000}),
                                           device.stream<double>({1000}), device.stream<double>({1000})};
    simple(streamOf<double>(device, x), streamOf<double>(device, y), r[0], r[1], r[2], r[3]);
    std::array<std::vector<double>, 4> results = {r[0].read(), r[1].read(), r[2].read(), r[3].read()};
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double a = x[i], b = y[i];
      const double wanted[] = {a - std::floor(a) + std::copysign(1.0, b) * std::fabs(a),
                               std::min(a, b) - std::max(a, 0.1),
                               std::clamp(a, -1.0, 1.0) + (b < 0.25 ? 0 : 1) + std::clamp(a, 0.0, 1.0),
                               a * 0.75 + b * 0.25 + a * b + 0.5};
      const double error =
          static_cast<double>(precisionOf(config)) * 8 * (1 + std::fabs(a) + std::fabs(b) + std::fabs(a * b));
      for (std::size_t k = 0; k < 4; ++k) {
        INFO("result " << k << " of " << a << ", " << b);
        CHECK(std::fabs(results[k][i] - wanted[k]) <= error);
      }
    }
  });
}

TEST_CASE("remainders, smooth steps and powers of two of doubles") {
  const std::vector<double> x = randomDoubles(1000, 61, 2), y = randomDoubles(1000, 62, 2);
  std::vector<int> e(1000);
  for (int i = 0; i < 1000; ++i) e[static_cast<std::size_t>(i)] = i % 121 - 60;
  const auto mod = [](double a, double b) { return a - b * std::floor(a / b); };
  const auto smooth = [](double low, double high, double v) {
    const double t = std::clamp((v - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    auto r0 = device.stream<double>({1000}), r1 = device.stream<double>({1000}),
         r2 = device.stream<double>({1000});
    auto r3 = device.stream<sk::double2>({1000});
    modular(streamOf<double>(device, x), streamOf<double>(device, y), streamOf<int>(device, e), r0, r1, r2,
            r3);
    const auto mods = r0.read(), fmods = r1.read(), powers = r2.read();
    const auto steps = r3.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double a = x[i], b = y[i];
      INFO(a << ", " << b << ", " << e[i]);
      // The error of the quotient is multiplied by the divisor, which gives about |a|.
      const double error = static_cast<double>(precisionOf(config)) * 8 * (1 + std::fabs(a) + std::fabs(b));
      CHECK(std::fabs(mods[i] - (mod(a, b) + mod(b, 0.75))) <= error);
      CHECK(std::fabs(fmods[i] - std::fmod(a, b)) <= error);
      CHECK(std::fabs(powers[i] - std::ldexp(a, e[i])) <=
            static_cast<double>(precisionOf(config)) * std::ldexp(std::fabs(a), e[i]));
      // The slope of smoothstep is at most 1.5.
      CHECK(std::fabs(steps[i].x - (smooth(-1, 2, a) + smooth(b, b + 1, a))) <= 4 * error);
      CHECK(std::fabs(steps[i].y - (smooth(-1, 2, b) + smooth(0, 3, a))) <= 4 * error);
    }
  });
}

TEST_CASE("powers of two beyond the range of doubles") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::vector<double> x = {1.5, -3.25, 0x1p-120, 0x1p120, 0.0, inf, -inf, std::nan(""), 7, 7};
  const std::vector<int> e = {100, -100, 240, -240, 5000, -5000, 3, 4, 5000, -5000};
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    const auto n = static_cast<std::int64_t>(x.size());
    auto r0 = device.stream<double>({n}), r1 = device.stream<double>({n}), r2 = device.stream<double>({n});
    auto r3 = device.stream<sk::double2>({n});
    modular(streamOf<double>(device, x), streamOf<double>(device, std::vector<double>(x.size(), inf)),
            streamOf<int>(device, e), r0, r1, r2, r3);
    const auto fmods = r1.read(), powers = r2.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i] << ", " << e[i]);
      const double wanted = std::ldexp(x[i], e[i]);
      CHECK((std::isnan(wanted) ? std::isnan(powers[i]) : powers[i] == wanted));
      CHECK((std::isfinite(x[i]) ? fmods[i] == x[i] : std::isnan(fmods[i])));
    }
  });
}
