// SPDX-License-Identifier: MIT
//
// Promises: .with({.precision = ...}) computes a kernel's floats as pairs of floats, as doubles or as halves, on every
// profile and natively, and gives floats; kernels that have no such variant are rejected.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "precision.sk.hpp"
#include "sk/sk.hpp"
#include "support/configuration_file.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using sk::Precision;

// A result is computed with an error far below an ulp, then rounded to float: half an ulp and a little more.
constexpr double halfUlp = 0x1.001p-24;

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values) {
  auto stream = device.stream<T>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

std::vector<float> numbers(std::size_t n, unsigned seed, float low, float high) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(low, high);
  std::vector<float> x;
  while (x.size() < n) x.push_back(value(random));
  return x;
}

/// The precisions above float that a device has.
std::vector<Precision> widePrecisions(const sk::Device& device) {
  if (device.name() == "native" || device.profile() == "glsl330")
    return {Precision::Extended, Precision::Double};
  return {Precision::Extended};
}

void checkRounded(const std::vector<float>& got, const std::vector<double>& exact) {
  REQUIRE(got.size() == exact.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    INFO(i << ": " << got[i] << ", not " << exact[i]);
    CHECK(std::fabs(got[i] - exact[i]) <= halfUlp * std::fabs(exact[i]));
  }
}

TEST_CASE("what floats lose, wider ones keep") {
  onSomeLayouts([](sk::Device& device) {
    const std::vector<float> a = numbers(1000, 1, 1e4F, 1e6F);
    const std::vector<float> b = numbers(1000, 2, -1, 1);
    const auto as = streamOf(device, a);
    const auto bs = streamOf(device, b);
    auto r = device.stream<float>({1000});
    for (const Precision precision : widePrecisions(device)) {
      precision::cancel.with({.precision = precision})(as, bs, r);
      checkRounded(r.read(), {b.begin(), b.end()});
    }
  });
}

TEST_CASE("functions, arrays, gathers and constants") {
  sk::Device reference = sk::Device::reference();
  onEveryTarget([&](sk::Device& device) {
    const std::vector<float> x = numbers(777, 3, -2, 2);
    const std::array<float, 4> c = {0.3F, -1.7F, 2.1F, 0.9F};
    const auto run = [&](sk::Device& on, Precision precision) {
      const auto xs = streamOf(on, x);
      auto r = on.stream<float>({777}), s = on.stream<float>({777});
      precision::polynomial.with({.precision = precision})(xs, c, r);
      precision::smooth.with({.precision = precision})(xs, 3.3F, xs, s);
      return std::pair(std::move(r), std::move(s));
    };
    auto [exactR, exactS] = run(reference, Precision::Default);
    for (const Precision precision : widePrecisions(device)) {
      auto [r, s] = run(device, precision);
      const std::vector<double> polynomial = exactR.readReals();
      const std::vector<float> got = r.read();
      // Near a root, the error of pairs of floats shows: 8 operations with errors of 2^-44, on terms up to 20.
      for (std::size_t i = 0; i < got.size(); ++i) {
        CHECK(std::fabs(got[i] - polynomial[i]) <= halfUlp * std::fabs(polynomial[i]) + 160 * 0x1p-44);
      }
      checkRounded(s.read(), exactS.readReals());
    }
  });
}

TEST_CASE("literals and formulas of literals have the precision of the variant") {
  const auto check = [](sk::Device& device, Precision precision, double bound) {
    auto x = streamOf<float>(device, {3});
    auto r = device.stream<sk::float4>({1}, sk::Storage::Double);
    auto s = device.stream<sk::float2>({1}, sk::Storage::Double);
    auto u = device.stream<sk::float2>({1}, sk::Storage::Double);
    precision::formulas.with({.precision = precision})(x, r, s);
    precision::formulasOfUniforms.with({.precision = precision})(1, 3, 1e-4F, 16777214, x, u);
    const std::vector<double> a = r.readReals(), b = s.readReals(), c = u.readReals();
    CHECK(std::fabs(a[0] - 1) <= bound);
    CHECK(std::fabs(c[0] - 1) <= bound);
    CHECK(std::fabs(a[1] - 1) <= bound);
    CHECK(std::fabs(a[2] - 3 * 0.1) <= bound);
    CHECK(std::fabs(a[3] + 3 * double{0.1F}) <= bound);
    CHECK(std::fabs(b[0] - (3 + 1e-4 * 16777214.0)) <= 4096 * bound);
    CHECK(std::fabs(b[1] - (precision == Precision::Single ? 3 : 4)) <= bound);
    auto h = device.stream<sk::half>({1});
    precision::negativeLiterals.with({.precision = precision})(x, r, h);
    const std::vector<double> d = r.readReals();
    for (const std::size_t i : {0, 1, 2}) CHECK(std::fabs(d[i] + 3 * 0.1) <= bound);
    CHECK(std::fabs(d[3] - 3 * 0.1) <= bound);
    CHECK(float{h.read()[0]} == -1.0009765625F);
  };
  onEveryTarget([&](sk::Device& device) {
    for (const Precision precision : widePrecisions(device)) check(device, precision, 0x1p-42);
    check(device, Precision::Single, 0x1p-21);
    auto x = streamOf<float>(device, {0});
    auto r = device.stream<sk::float4>({1});
    auto s = device.stream<sk::float2>({1}), u = device.stream<sk::float2>({1});
    precision::formulas.with({.precision = Precision::Half})(x, r, s);
    precision::formulasOfUniforms.with({.precision = Precision::Half})(1, 3, 1e-4F, 16777214, x, u);
    CHECK(s.read()[0].x == std::numeric_limits<float>::infinity());
    CHECK(u.read()[0].y == std::numeric_limits<float>::infinity());
  });
  sk::Device reference = sk::Device::reference();
  check(reference, Precision::Default, 0x1p-51);
}

TEST_CASE("the text of a literal is rounded to half once") {
  onEveryTarget([](sk::Device& device) {
    auto x = streamOf<float>(device, {1});
    auto r = device.stream<sk::half2>({1});
    auto s = device.stream<sk::float2>({1});
    precision::halfLiterals(x, r, s);
    CHECK(float{r.read()[0].x} == 1 + 0x1p-10F);
    CHECK(float{r.read()[0].y} == 1 + 0x1p-10F);
    precision::halfLiterals.with({.precision = Precision::Half})(x, r, s);
    CHECK(float{r.read()[0].x} == 1 + 0x1p-10F);
    CHECK(s.read()[0].x == 1 + 0x1p-10F);
    CHECK(s.read()[0].y == float{sk::half(0.1F)});
  });
}

TEST_CASE("structs and vectors") {
  sk::Device reference = sk::Device::reference();
  onEveryTarget([&](sk::Device& device) {
    std::vector<precision::Body> bodies;
    std::vector<sk::float3> forces;
    for (int i = 0; i < 50; ++i) {
      const float f = static_cast<float>(i);
      bodies.push_back({{f + 0.1F, 1.5F, -f}, 0.3F + f, i});
      forces.push_back({0.7F, -f, 9.1F});
    }
    const auto run = [&](sk::Device& on, Precision precision) {
      auto moved = on.stream<precision::Body>({50});
      auto there = on.stream<sk::float3>({50});
      precision::move.with({.precision = precision})(streamOf(on, bodies), streamOf(on, forces), 0.01F, moved,
                                                     there);
      return std::pair(moved.read(), there.read());
    };
    const auto [exactMoved, exactThere] = run(reference, Precision::Default);
    for (const Precision precision : widePrecisions(device)) {
      const auto [moved, there] = run(device, precision);
      for (std::size_t i = 0; i < moved.size(); ++i) {
        CHECK(moved[i].id == static_cast<int>(i) + 1);
        CHECK(moved[i].place == exactMoved[i].place);  // both rounded from a much better value
        CHECK(moved[i].mass == bodies[i].mass);
        CHECK(there[i] == exactThere[i]);
      }
    }
  });
}

TEST_CASE("append outputs, bits and narrow types") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> a = numbers(300, 5, 0, 9);
    for (const Precision precision : widePrecisions(device)) {
      auto pushed = device.stream<float>({300});
      auto scattered = device.stream<float>({300});
      precision::choose.with({.precision = precision})(streamOf(device, a), 1.5F, pushed, scattered);
      std::vector<float> expected, squares;
      for (const float x : a) {
        if (x / 3.0 > 1.5) expected.push_back(static_cast<float>(x / 3.0));
        squares.push_back(static_cast<float>((x / 3.0) * (x / 3.0)));
      }
      CHECK(pushed.read() == expected);
      CHECK(scattered.read() == squares);
      auto exponent = device.stream<std::int32_t>({300});
      auto h = device.stream<sk::half>({300});
      auto back = device.stream<float>({300});
      precision::bits.with({.precision = precision})(streamOf(device, a), exponent, h, back);
      const auto exponents = exponent.read();
      const auto backs = back.read();
      for (std::size_t i = 0; i < a.size(); ++i) {
        std::int32_t bits;
        std::memcpy(&bits, &a[i], sizeof bits);
        CHECK(exponents[i] == ((bits >> 23) & 255));
        CHECK(backs[i] == a[i] * 0.5F);
      }
    }
  });
}

TEST_CASE("reduces") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = numbers(5000, 7, -1, 1);
    double exact = 0, product = 1;
    for (const float v : x) exact += v;
    std::vector<float> factors = numbers(100, 8, 0.5F, 2);
    for (const float v : factors) product *= v;
    const auto xs = streamOf(device, x);
    for (const Precision precision : widePrecisions(device)) {
      CHECK(precision::sum.with({.precision = precision})(xs) == static_cast<float>(exact));
      CHECK(precision::product.with({.precision = precision})(streamOf(device, factors)) ==
            static_cast<float>(product));
      const precision::Moments m = precision::moments.with({.precision = precision})(xs, 0.1F);
      double s = 0, ss = 0;
      for (const float v : x) {
        s += v - double{0.1F};
        ss += (v - double{0.1F}) * (v - double{0.1F});
      }
      CHECK(m.n == 5000);
      CHECK(m.s == static_cast<float>(s));
      CHECK(m.ss == static_cast<float>(ss));
    }
    CHECK(precision::sum.with({.accumulate = sk::Accumulate::Extended})(xs) == static_cast<float>(exact));
    CHECK(precision::sum.with({.precision = Precision::Extended})(streamOf<float>(device, {})) == 0);
  });
}

TEST_CASE("reduces to streams, and of vectors") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = numbers(3000, 9, -1, 1);
    auto xs = device.stream<float>({3, 1000});
    xs.write(x);
    auto rows = device.stream<float>({5, 2});
    rows.write(std::vector<float>(10, 7));
    precision::sum.with({.accumulate = sk::Accumulate::Extended})(xs, rows.domain({1, 1}, {4, 2}));
    const std::vector<float> got = rows.read();
    for (std::size_t r = 0; r < 3; ++r) {
      double exact = 0;
      for (std::size_t i = 0; i < 1000; ++i) exact += x[r * 1000 + i];
      CHECK(got[2 * (r + 1) + 1] == static_cast<float>(exact));
      CHECK(got[2 * r] == 7);
    }
    std::vector<sk::float2> pairs;
    double a = 0, b = 0;
    for (std::size_t i = 0; i + 1 < x.size(); i += 2) {
      pairs.push_back({x[i], x[i + 1]});
      a += double{x[i]} * x[i];
      b += double{x[i + 1]} * x[i + 1];
    }
    const sk::float2 total =
        precision::squares.with({.precision = Precision::Extended})(streamOf(device, pairs));
    CHECK(total.x == static_cast<float>(a));
    CHECK(total.y == static_cast<float>(b));
  });
}

/// x, rounded to the nearest half.
float toHalf(double x) { return static_cast<float>(sk::half(static_cast<float>(x))); }

TEST_CASE("halves round every operation") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> a = numbers(500, 11, -30, 30);
    const std::vector<float> b = numbers(500, 12, -30, 30);
    auto r = device.stream<float>({500});
    precision::cancel.with({.precision = Precision::Half})(streamOf(device, a), streamOf(device, b), r);
    const std::vector<float> got = r.read();
    for (std::size_t i = 0; i < a.size(); ++i) {
      const float x = toHalf(a[i]);
      CHECK(got[i] == toHalf(double{toHalf(double{x} + toHalf(b[i]))} - x));
    }
    // A sum of ones in sequence would stop at 2048.
    const std::vector<float> ones(1 << 14, 1.0F);
    CHECK(precision::sum.with({.precision = Precision::Half})(streamOf(device, ones)) == 16384);  // a tree
    CHECK(precision::product.with({.precision = Precision::Half})(streamOf<float>(device, {300, 300})) ==
          std::numeric_limits<float>::infinity());
  });
}

TEST_CASE("halves are the same natively") {
  const std::vector<float> a = numbers(300, 21, -30, 30);
  const std::vector<float> b = numbers(300, 22, 1, 30);
  const auto computed = [&](sk::Device& device) {
    auto r = device.stream<float>({300});
    precision::smooth.with({.precision = Precision::Half})(streamOf(device, a), 0.3F, streamOf(device, b), r);
    auto p = device.stream<float>({300});
    precision::polynomial.with({.precision = Precision::Half})(r, std::array{0.1F, 0.2F, 0.3F, 0.4F}, p);
    return p.read();
  };
  CHECK(computed(device("native")) == computed(device("glsl330")));
}

TEST_CASE("what computes no floats is the same in every precision") {
  onEveryTarget([](sk::Device& device) {
    auto r = device.stream<std::int32_t>({3});
    precision::integers.with({.precision = Precision::Extended})(streamOf<std::int32_t>(device, {1, 2, 3}),
                                                                 r);
    CHECK(r.read() == std::vector<std::int32_t>{2, 3, 4});
    CHECK(precision::count.with({.precision = Precision::Extended})(r) == 9);
  });
}

TEST_CASE("a declaration chooses where a call does not") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> a = numbers(100, 1, 1e4F, 1e6F);
    const std::vector<float> b = numbers(100, 2, -1, 1);
    const auto as = streamOf(device, a);
    const auto bs = streamOf(device, b);
    auto r = device.stream<float>({100});
    precision::cancelWell(as, bs, r);
    CHECK(r.read() == b);
    const auto x = streamOf(device, numbers(4000, 9, -1, 1));
    CHECK(precision::sumPlainly(x) == precision::sum.with({.accumulate = sk::Accumulate::Tree})(x));
    const auto well = precision::sumPlainly.with({.accumulate = sk::Accumulate::Compensated});
    CHECK(well(x) == precision::sum(x));
  });
}

TEST_CASE("a file chooses, too") {
  const ConfigurationFile file(
      "[kernels.\"precision::cancel\"]\nprecision = \"extended\"\n"
      "[kernels.\"*\"]\naccumulate = \"tree\"\n");
  sk::Device device({.profile = "glsl330", .configuration = file.path});
  const std::vector<float> a = numbers(100, 1, 1e4F, 1e6F);
  const std::vector<float> b = numbers(100, 2, -1, 1);
  auto r = device.stream<float>({100});
  precision::cancel(streamOf(device, a), streamOf(device, b), r);
  CHECK(r.read() == b);
  const auto x = streamOf(device, numbers(4000, 9, -1, 1));
  CHECK(precision::sum(x) == precision::sumPlainly(x));
  CHECK(precision::count(streamOf<std::int32_t>(device, {1, 2})) == 3);  // no sum of floats
}

TEST_CASE("a file's forced choices override those of calls") {
  const std::vector<float> a = numbers(100, 1, 1e4F, 1e6F), b = numbers(100, 2, -1, 1);
  const auto x = numbers(4000, 9, -1, 1);
  for (const bool isForced : {false, true}) {
    const std::string choice =
        std::string("precision = \"double\"\nforce = ") + (isForced ? "true\n" : "false\n");
    const ConfigurationFile file("[kernels.\"precision::cancel\"]\n" + choice +
                                 "[kernels.\"precision::sum\"]\n" + choice);
    sk::Device device({.device = "native", .configuration = file.path});
    auto r = device.stream<float>({100});
    precision::cancel.with({.precision = Precision::Single})(streamOf(device, a), streamOf(device, b), r);
    CHECK((r.read() == b) == isForced);
    // an exact sum is of floats: it gives way to the precision of the file, or excludes it
    const auto exactly = [&] {
      precision::sum.with({.accumulate = sk::Accumulate::Exact})(streamOf(device, x));
    };
    CHECK((errorOf(exactly) == "no error") == isForced);
  }
}

TEST_CASE("mistakes in a file are told with their line") {
  const auto errorIn = [](const std::string& text) {
    const ConfigurationFile file(text);
    return errorOf([&] { sk::Device({.profile = "glsl330", .configuration = file.path}); });
  };
  CHECK(errorIn("[kernels.a]\nprecision = \"quad\"\n")
            .find(":2: precision is one of \"half\", \"single\", \"extended\", \"double\"") !=
        std::string::npos);
  CHECK(
      errorIn("[kernels.a]\ncontraction = \"on\"\n").find(":2: contraction is one of \"exact\", \"fast\"") !=
      std::string::npos);
  CHECK(errorIn("[kernels.a]\n\nspeed = 1\n").find(":3: there is no choice 'speed'") != std::string::npos);
  CHECK(errorIn("[kernels.a]\nforce = \"yes\"\n").find(":2: force is true or false") != std::string::npos);
  CHECK(errorIn("[kernel]\n").find(":1: expected tables like [kernels.") != std::string::npos);
  CHECK(errorIn("precision\n").find(":1: ") != std::string::npos);
  CHECK(errorOf([&] {
          sk::Device({.profile = "glsl330", .configuration = "/nowhere.toml"});
        }).find("/nowhere.toml (option or SK_CONFIG)") == 0);
}

TEST_CASE("nearly right names in a file are mistakes, names of other programs are not") {
  const auto errorIn = [](const std::string& text) {
    const ConfigurationFile file(text);
    return errorOf([&] { sk::Device({.device = "native", .configuration = file.path}); });
  };
  CHECK_THAT(
      errorIn("\n[kernels.\"precision::summ\"]\nprecision = \"double\"\n"),
      Catch::EndsWith(":2: the program has no kernel 'precision::summ'; did you mean 'precision::sum'?"));
  CHECK_THAT(errorIn("[kernels.cancel]\n"), Catch::EndsWith("did you mean 'precision::cancel'?"));
  CHECK_THAT(errorIn("[kernels.\"precison::cancel\"]\n"),
             Catch::EndsWith("did you mean 'precision::cancel'?"));
  CHECK(errorIn("[kernels.\"precision::cancel\"]\n") == "no error");
  const std::string ofOthers =
      "[kernels.\"ocean::waves\"]\n[tables.\"ocean::response\"]\n[streams.u]\nstorage = \"half\"\n";
  CHECK(errorIn(ofOthers) == "no error");
}

TEST_CASE("exact and compensated sums are of floats") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf<float>(device, {1, 2});
    for (const auto accumulate : {sk::Accumulate::Exact, sk::Accumulate::Compensated}) {
      const auto both = precision::sum.with({.accumulate = accumulate, .precision = Precision::Extended});
      CHECK(errorOf([&] { both(x); }).find("call it in Precision::Single") != std::string::npos);
    }
  });
}

// The functions are the same text on every profile, and large; numerics.double_intrinsics measures each of them.
TEST_CASE("sines and exponentials, on doubles inside") {
  for (const char* profile : {"glsl330", "native"}) {
    sk::Device& device = run_tests::device(profile);
    const std::vector<float> x = numbers(1000, 21, -40, 40);
    std::vector<double> sines, powers;
    for (const float v : x) {
      sines.push_back(std::sin(double{v}));
      powers.push_back(std::pow(std::exp(std::tanh(double{v}) / 2), v - 1.0));
    }
    auto r = device.stream<float>({1000}), p = device.stream<float>({1000});
    for (const Precision precision : widePrecisions(device)) {
      precision::waves.with({.precision = precision})(streamOf(device, x), r, p);
      checkRounded(r.read(), sines);
      checkRounded(p.read(), powers);
    }
  }
}

TEST_CASE("elements are interpolated in doubles") {
  sk::Device reference = sk::Device::reference();
  for (const char* profile : {"glsl330", "native"}) {  // positions are found before elements are addressed
    sk::Device& device = run_tests::device(profile);
    const std::vector<float> values = numbers(210, 31, -1, 1);
    std::vector<sk::float2> a, x;
    std::vector<sk::float3> c;
    for (std::size_t i = 0; i < 70; ++i) {
      a.push_back({values[i], values[i + 70]});
      c.push_back({values[i], values[i + 70], values[i + 140]});
    }
    for (const float v : numbers(400, 32, -30, 30)) x.push_back({v, v * 1.7F});
    for (const float v : {0.0F, 3.0F, -6.0F, 1e8F, -1e30F, std::numeric_limits<float>::infinity()})
      x.push_back({v, v});
    const auto n = static_cast<std::int64_t>(x.size());
    const auto run = [&](sk::Device& on, Precision precision) {
      auto as = on.stream<sk::float2>({7, 10});
      auto cs = on.stream<sk::float3>({2, 5, 7});
      as.write(a);
      cs.write(c);
      auto r = on.stream<sk::float2>({n});
      auto s = on.stream<float>({n});
      auto t = on.stream<sk::float3>({n});
      precision::between.with({.precision = precision})(as, streamOf(on, values), cs, streamOf(on, x), r, s,
                                                        t);
      std::vector<double> all = r.readReals();
      for (const double v : s.readReals()) all.push_back(v);
      for (const double v : t.readReals()) all.push_back(v);
      return all;
    };
    const std::vector<double> exact = run(reference, Precision::Default);
    for (const Precision precision : widePrecisions(device)) {
      const std::vector<double> got = run(device, precision);
      REQUIRE(got.size() == exact.size());
      for (std::size_t i = 0; i < got.size(); ++i) {
        INFO(i << ": " << got[i] << ", not " << exact[i]);
        // The position, up to 50, has a relative error of 2^-44, which multiplies a difference of elements of up to 2.
        if (!std::isnan(exact[i]))
          CHECK(std::fabs(got[i] - exact[i]) <= halfUlp * std::fabs(exact[i]) + 0x1p-36);
      }
    }
  }
}

TEST_CASE("what has no form is refused") {
  sk::Device& device = run_tests::device("glsl330");
  auto a = streamOf<float>(device, {1, 2});
  auto r = device.stream<float>({2});
  auto h = device.stream<sk::half>({2});
  CHECK(errorOf([&] {
          precision::betweenHalves.with({.precision = Precision::Extended})(h, a, r);
        }).find("sample() of a type with fewer bits interpolates in floats") != std::string::npos);
  auto v = device.stream<sk::float2>({2});
  const std::string turned =
      errorOf([&] { precision::turned.with({.precision = Precision::Double})({}, v, v); });
  CHECK(turned.find("precision::turned: it has no form in doubles: matrices are of floats") == 0);
  CHECK(turned.find("precision.sk:") != std::string::npos);
  sk::Device& es = run_tests::device("essl300");
  auto b = streamOf<float>(es, {1, 2});
  auto s = es.stream<float>({2});
  CHECK(errorOf([&] {
          precision::cancel.with({.precision = Precision::Double})(b, b, s);
        }).find("has no doubles of its own; call it in Precision::Extended") != std::string::npos);
  CHECK(errorOf([&] {
          precision::cancel.with({.accumulate = sk::Accumulate::Tree})(a, a, r);
        }).find("it is not a reduce") != std::string::npos);
}

}  // namespace
}  // namespace run_tests
