// SPDX-License-Identifier: MIT
//
// Promises: a stream may store its floats as halves or doubles; halves are rounded to nearest, and a stream of doubles keeps
// what a kernel computes in doubles.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "precision.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using sk::Precision;
using sk::Storage;

const std::array<float, 4> identity = {0, 1, 0, 0};

std::vector<float> numbers(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> mantissa(-2, 2);
  std::uniform_int_distribution<int> exponent(-26, 17);
  std::vector<float> x;
  while (x.size() < n) x.push_back(std::ldexp(mantissa(random), exponent(random)));
  return x;
}

std::vector<float> halved(std::vector<float> x) {
  for (float& value : x) value = sk::half(value);
  return x;
}

TEST_CASE("halves are rounded to nearest, by the host and by kernels") {
  onSomeLayouts([](sk::Device& device) {
    std::vector<float> x = numbers(600, 1);
    x.insert(x.end(), {0.0F, 65519.9F, 65520.0F, -1e9F, 2049.0F, 2051.0F, 1e-8F,
                       std::numeric_limits<float>::infinity()});
    const auto count = static_cast<std::int64_t>(x.size());
    auto h = device.stream<float>({count}, Storage::Half);
    h.write(x);
    CHECK(h.read() == halved(x));
    auto f = device.stream<float>({count});
    f.write(x);
    auto r = device.stream<float>({count}, Storage::Half);
    precision::polynomial(f, std::array<float, 4>{0, 1, 0, 0}, r);
    const std::vector<float> got = r.read();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(x[i]);
      if (std::isfinite(x[i])) CHECK(got[i] == static_cast<float>(sk::half(x[i])));
    }
    precision::polynomial(h, std::array<float, 4>{0, 0.5F, 0, 0}, f);
    const std::vector<float> scaled = f.read();
    const std::vector<float> held = halved(x);
    for (std::size_t i = 0; i < 600; ++i) {
      if (std::isfinite(held[i])) CHECK(scaled[i] == 0.5F * held[i]);  // 0 times infinity is NaN
    }
  });
}

TEST_CASE("doubles are rounded to halves once, by the host and by kernels") {
  onSomeLayouts([](sk::Device& device) {
    const bool hasDoubles = !device.profile().starts_with("essl");
    const auto options = sk::CallOptions{.precision = hasDoubles ? Precision::Double : Precision::Extended};
    auto h = device.stream<float>({4}, Storage::Half);
    const std::vector<double> x = {1 + 0x1p-11 + 0x1p-30, 1 + 0x1p-11 - 0x1p-30, -1 - 0x1p-11 - 0x1p-34,
                                   65520 - 0x1p-20};
    const std::vector<float> wanted = {1 + 0x1p-10F, 1, -1 - 0x1p-10F, 65504};
    h.writeReals(x);
    CHECK(h.read() == wanted);
    std::vector<float> head, tail;
    for (const double value : x) {
      head.push_back(static_cast<float>(value));
      tail.push_back(static_cast<float>(value - double{head.back()}));
    }
    auto a = device.stream<float>({4}), b = device.stream<float>({4});
    a.write(head);
    b.write(tail);
    h.fill(0);
    precision::added.with(options)(a, b, h);
    CHECK(h.read() == wanted);
  });
}

TEST_CASE("doubles keep what is computed in doubles") {
  sk::Device reference = sk::Device::reference();
  onSomeLayouts([&](sk::Device& device) {
    const std::vector<float> x = numbers(300, 3);
    const bool hasDoubles = !device.profile().starts_with("essl");
    const auto options = sk::CallOptions{.precision = hasDoubles ? Precision::Double : Precision::Extended};
    const auto run = [&](sk::Device& on, Storage storage, const sk::CallOptions& chosen) {
      auto xs = on.stream<float>({300});
      xs.write(x);
      auto s = on.stream<float>({300}, storage);
      auto p = on.stream<float>({300}, storage);
      precision::smooth.with(chosen)(xs, 3.3F, xs, s);
      precision::polynomial.with(chosen)(s, std::array<float, 4>{0.3F, 1.7F, 0.1F, 0}, p);
      return p.readReals();
    };
    const std::vector<double> exact = run(reference, Storage::Single, {});
    const std::vector<double> got = run(device, Storage::Double, options);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      CHECK(std::fabs(got[i] - exact[i]) <= 0x1p-40 * (0.3 + std::fabs(exact[i])) + 1e-25);
    }
    // If the kernel computes in float, a stream of doubles holds floats.
    for (const double v : run(device, Storage::Extended, {}))
      CHECK((v == static_cast<float>(v) || std::isnan(v)));
  });
}

TEST_CASE("numbers beyond float get in and out") {
  onEveryTarget([](sk::Device& device) {
    auto s = device.stream<sk::float3>({2}, Storage::Double);
    const std::vector<double> values = {0.1, 1.0 / 3, -2e-5, 1e10 / 7, 5, 6.25};
    s.writeReals(values);
    CHECK(s.readReals() == values);
    CHECK(s.read()[0] == sk::float3{0.1F, static_cast<float>(1.0 / 3), -2e-5F});
    CHECK_THROWS_WITH(s.writeReals(std::vector<double>{1, 2}), Catch::Contains("2 numbers are given"));
  });
}

TEST_CASE("structs, vectors, gathers and reduces") {
  onEveryTarget([](sk::Device& device) {
    for (const Storage storage : {Storage::Half, Storage::Extended, Storage::Double}) {
      std::vector<precision::Body> bodies = {{{1.5F, -2, 0.25F}, 2, 7}, {{8, 9, -10}, 0.5F, 8}};
      auto b = device.stream<precision::Body>({2}, storage);
      b.write(bodies);
      auto moved = device.stream<precision::Body>({2}, storage);
      auto force = device.stream<sk::float3>({2}, storage);
      force.write(std::vector<sk::float3>{{4, 8, 16}, {1, 2, 3}});
      auto there = device.stream<sk::float3>({2}, storage);
      if (device.limits().drawBuffers < 6 && storage != Storage::Half) {
        CHECK_THROWS_WITH(precision::move(b, force, 0.5F, moved, there),
                          Catch::Contains("6 planes to write"));
        continue;
      }
      precision::move(b, force, 0.5F, moved, there);
      const auto result = moved.read();
      CHECK(result[0].place == sk::float3{2, -1, 2.25F});
      CHECK(result[1].place == sk::float3{8.5F, 10, -8.5F});
      CHECK(result[1].id == 9);
      CHECK(result[0].mass == 2);
      CHECK(std::fabs(there.read()[1].x -
                      8.5F / std::sqrt(8.5F * 8.5F + 100 + 8.5F * 8.5F) * std::sqrt(14.0F)) < 0.01F);
      auto a = device.stream<float>({4}, storage);
      a.write(std::vector<float>{1, 2, 3, 4});
      auto r = device.stream<float>({4}, storage);
      precision::smooth(a, 1.0F, a, r);
      CHECK(std::fabs(r.read()[0] - (0.1F * 1 / 3 + 0.7F * 1 / 2 + 0.2F * 2 / 1.5F)) < 1e-3F);
      CHECK(precision::sum(a) == 10);
      CHECK(precision::sum.with({.precision = Precision::Extended})(a) == 10);
      auto total = device.stream<float>({2}, storage);
      precision::sum(a, total);
      CHECK(total.read() == std::vector<float>{3, 7});
    }
  });
}

/// Thirds of numbers, so that no float holds one of them.
std::vector<double> thirds(std::size_t n) {
  std::vector<double> x;
  for (std::size_t i = 0; i < n; ++i) x.push_back((static_cast<double>(i * 37 % 101) - 40) / 3);
  return x;
}

double sumOf(const std::vector<double>& x, std::size_t begin, std::size_t end, int power = 1) {
  long double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += power == 1 ? x[i] : static_cast<long double>(x[i]) * x[i];
  return static_cast<double>(sum);
}

TEST_CASE("a reduce in doubles keeps them in a stream of doubles") {
  const std::vector<double> x = thirds(300);
  const std::array<double, 4> sums = {sumOf(x, 0, 75), sumOf(x, 75, 150), sumOf(x, 150, 225),
                                      sumOf(x, 225, 300)};
  const std::vector<std::int32_t> starts = {0, 75, 150, 225, 300};
  const auto check = [&](sk::Device& device, const sk::CallOptions& options) {
    constexpr double bound = 0x1p-34;  // 300 terms of at most 20, with 2^-44 of the sum of magnitudes
    const auto isSum = [&](const std::vector<double>& got) {
      REQUIRE(got.size() == sums.size());
      for (std::size_t i = 0; i < sums.size(); ++i) CHECK(std::fabs(got[i] - sums[i]) <= bound);
    };
    auto s = device.stream<float>({300}, Storage::Double);
    s.writeReals(x);
    for (const Storage storage : {Storage::Extended, Storage::Double}) {
      auto blocks = device.stream<float>({4}, storage), inRows = device.stream<float>({4}, storage);
      precision::sum.with(options)(s, blocks);
      isSum(blocks.readReals());
      auto at = device.stream<std::int32_t>({5});
      at.write(starts);
      precision::sum.with(options)(sk::Rows(at)(s), inRows);
      isSum(inRows.readReals());
      auto strided = device.stream<float>({8}, storage);
      strided.fill(0);
      auto every = sk::stride(strided, {2});
      precision::sum.with(options)(s, every);
      const std::vector<double> all = strided.readReals();
      isSum({all[0], all[2], all[4], all[6]});
      auto running = device.stream<float>({300}, storage);
      precision::running.with(options)(s, running);
      CHECK(std::fabs(running.readReals()[299] - sumOf(x, 0, 300)) <= bound);
      auto moments = device.stream<precision::Moments>({1}, storage);
      precision::moments.with(options)(s, 0.0F, moments);
      CHECK(std::fabs(moments.readReals()[1] - sumOf(x, 0, 300)) <= bound);
      CHECK(std::fabs(moments.readReals()[2] - sumOf(x, 0, 300, 2)) <= 16 * bound);
      auto r = device.stream<float>({300}, storage);
      auto total = device.stream<float>({1}, storage), most = device.stream<float>({1}, storage);
      precision::doubled.with(options)(s, r, total, most);
      CHECK(std::fabs(total.readReals()[0] - 2 * sumOf(x, 0, 300)) <= bound);
      CHECK(std::fabs(most.readReals()[0] - 2 * x[30]) <= bound);
    }
    // Halves are rounded once.
    auto half = device.stream<float>({1}, Storage::Half), one = device.stream<float>({1}, Storage::Double);
    one.writeReals(std::vector<double>{1 + 0x1p-11 + 0x1p-40});
    precision::sum.with(options)(one, half);
    CHECK(half.readReals()[0] == 1 + 0x1p-10);
  };
  onEveryTarget([&](sk::Device& device) { check(device, {.precision = Precision::Extended}); });
  onEveryTarget([&](sk::Device& device) { check(device, {.accumulate = sk::Accumulate::Extended}); });
  for (const char* name : {"glsl430", "native"})
    check(run_tests::device(name), {.precision = Precision::Double});
}

TEST_CASE("the storage of a stream that a switch leaves out does not matter") {
  sk::Device device({.device = "gl", .profile = "essl300", .limits = "guaranteed"});  // draws to 4 planes
  auto x = device.stream<float>({2}, Storage::Half);
  x.write(std::vector<float>{3, 5});
  auto r = device.stream<float>({2});
  auto place = device.stream<sk::float3>({2}, Storage::Double);
  place.write(std::vector<sk::float3>(2));
  auto moved = device.stream<sk::float3>({2}, Storage::Double);
  auto back = device.stream<sk::float3>({2}, Storage::Double);
  CHECK_THROWS_WITH(precision::moveIf(true, x, place, r, moved, back), Catch::Contains("5 planes to write"));
  precision::moveIf(false, x, place, r, moved, back);
  CHECK(r.read() == std::vector<float>{3, 5});
}

TEST_CASE("one stream for both, views") {
  onSomeLayouts([](sk::Device& device) {
    auto a = device.stream<float>({6, 5}, Storage::Half);
    std::vector<float> x(30);
    for (std::size_t i = 0; i < 30; ++i) x[i] = static_cast<float>(i) + 0.1F;
    a.write(x);
    precision::polynomial(a, identity, a);
    CHECK(a.read() == halved(x));
    auto part = a.domain({1, 1}, {3, 4});
    precision::polynomial(part, std::array<float, 4>{1, 0, 0, 0}, part);
    CHECK(a.read()[5 + 1] == 1);
    CHECK(a.read()[5] == halved(x)[5]);
  });
}

TEST_CASE("what holds no floats has no storage to choose") {
  sk::Device& device = run_tests::device("glsl330");
  CHECK(errorOf([&] {
          (void)device.stream<std::int32_t>({3}, Storage::Half);
        }).find("a stream of int has no float") == 0);
  auto a = device.stream<float>({3});
  auto pushed = device.stream<float>({3}, Storage::Half);
  auto scattered = device.stream<float>({3});
  CHECK(errorOf([&] {
          precision::choose(a, 1.0F, pushed, scattered);
        }).find("make it with Storage::Single") != std::string::npos);
}

}  // namespace
}  // namespace run_tests
