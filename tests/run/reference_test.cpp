// SPDX-License-Identifier: MIT
//
// Promises: the reference in __float128 runs any program that was compiled for it, stores and computes floats and doubles
// with 113 bits, and rejects other programs.
#include <cmath>
#include <cstdint>
#include <vector>

#include <quadmath.h>

#include <catch2/catch.hpp>

#include "native.sk.hpp"
#include "quad.sk.hpp"
#include "sk/sk.hpp"

namespace run_tests {
namespace {

__extension__ typedef __float128 Quad;

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values) {
  auto stream = device.stream<T>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

TEST_CASE("the reference in __float128 keeps what doubles lose") {
  sk::Device quads = sk::Device::reference(sk::Reference::Quad);
  CHECK(quads.name() == "reference (native, __float128)");
  CHECK(sk::Device("reference:quad").name() == quads.name());
  sk::Device doubles = sk::Device::reference();
  auto r = quads.stream<float>({2});
  quad::cancel(streamOf<float>(quads, {1, 0.1F}), r);
  CHECK(r.read() == std::vector<float>{1, 0.1F});
  auto lost = doubles.stream<float>({2});
  quad::cancel(streamOf<float>(doubles, {1, 0.1F}), lost);
  CHECK(lost.read() == std::vector<float>{0, 0});
  auto wide = quads.stream<double>({1});
  quad::cancelDoubles(streamOf<double>(quads, {0.1F}), wide);
  CHECK(wide.read() == std::vector<double>{0.1F});
}

TEST_CASE("exact sums in __float128 lose nothing") {
  sk::Device quads = sk::Device::reference(sk::Reference::Quad);
  const auto exact = quad::sum.with({.accumulate = sk::Accumulate::Exact});
  CHECK(exact(streamOf<float>(quads, {0x1p100F, 1, 0x1p-40F, -0x1p100F})) == 1 + 0x1p-40F);
  CHECK(exact(streamOf<float>(quads, {0x1p100F, 0x1p-40F, -0x1p100F})) == 0x1p-40F);
}

TEST_CASE("streams hold __float128 between calls") {
  sk::Device device = sk::Device::reference(sk::Reference::Quad);
  auto x = streamOf<float>(device, {1});
  auto third = device.stream<float>({1});
  const auto swapped = [&](const quad::Pair& pair) {
    auto in = device.stream<quad::Pair>({1});
    auto out = device.stream<quad::Pair>({1});
    in.write(std::vector{pair});
    quad::swap(in, out);
    quad::swap(out, in);
    return in.read().front();
  };
  const quad::Pair pair = swapped({7, 0.3, 4});
  CHECK(pair.value == 7.0F / 3);
  CHECK(pair.wide == static_cast<double>(static_cast<Quad>(0.3) / 3));
  CHECK(pair.id == 6);
}

TEST_CASE("functions are right to half a unit of double") {
  sk::Device device = sk::Device::reference(sk::Reference::Quad);
  const std::vector<float> x{0.1F, 0.7F, 0.99F};
  const auto in = streamOf(device, x);
  const auto check = [&](int which, auto right) {
    auto r = device.stream<float>({3});
    quad::function(which, in, r);
    const std::vector<double> got = r.readReals();
    for (std::size_t i = 0; i < x.size(); ++i) {
      INFO(which << " of " << x[i]);
      CHECK(got[i] == static_cast<double>(right(static_cast<Quad>(x[i]))));
    }
  };
  const auto one = static_cast<Quad>(1);
  check(0, sinq), check(1, cosq), check(2, tanq), check(3, asinq), check(4, acosq), check(5, atanq);
  check(6, sinhq), check(7, coshq), check(8, tanhq), check(9, asinhq), check(10, atanhq);
  check(11, expq), check(12, exp2q), check(13, logq), check(14, log2q), check(15, log10q), check(16, sqrtq);
  check(17, [&](Quad v) { return one / sqrtq(v); });
  check(18, [](Quad v) { return v; });
  check(19, rintq);
  check(20, log1pq), check(21, expm1q), check(22, cbrtq), check(23, erfq), check(24, erfcq);
  check(25, [](Quad v) { return hypotq(v, static_cast<Quad>(2)); });
  check(26, [](Quad v) {
    return powq(v, static_cast<Quad>(1.5F)) + sqrtq(v * v + 4) + fmodq(v, static_cast<Quad>(0.3)) + v * 8;
  });
}

TEST_CASE("reductions, pushes, iterators and samples") {
  sk::Device device = sk::Device::reference(sk::Reference::Quad);
  const auto x = streamOf<float>(device, {1e20F, 1, 2, -1e20F});
  CHECK(quad::sum(x) == 3);
  CHECK(quad::sum.with({.accumulate = sk::Accumulate::Tree})(x) == 3);
  CHECK(quad::largest(x) == 1e20F);
  auto halves = device.stream<float>({2});
  quad::sum(x, halves);
  CHECK(halves.read() == std::vector<float>{1e20F, -1e20F});
  auto pushed = device.stream<float>({1});
  quad::large(streamOf<float>(device, {1, 2, 3}), pushed);
  CHECK(pushed.readReals() == std::vector<double>{static_cast<double>(static_cast<Quad>(2) / 3), 1});
  auto between = device.stream<float>({1});
  quad::between(streamOf<float>(device, {1, 2, 4}), streamOf<float>(device, {1.5F}), between);
  CHECK(between.read() == std::vector<float>{3});
  auto ramp = device.stream<float>({4});
  quad::ramp(sk::iter(0.0F, 4.0F), ramp);
  CHECK(ramp.readReals()[1] == 1.0 / 7);
}

TEST_CASE("a reference computes in its own precision, whatever a call asks for") {
  for (const auto kind : {sk::Reference::Double, sk::Reference::Quad}) {
    sk::Device device = sk::Device::reference(kind);
    const auto x = streamOf<float>(device, {0.1F});
    auto r = device.stream<float>({1});
    quad::function(0, x, r);
    const std::vector<double> plain = r.readReals();
    for (const auto precision : {sk::Precision::Half, sk::Precision::Extended, sk::Precision::Double}) {
      quad::function.with({.precision = precision})(0, x, r);
      CHECK(r.readReals() == plain);
    }
  }
}

TEST_CASE("code that was not made for it is refused") {
  sk::Device device = sk::Device::reference(sk::Reference::Quad);
  const auto x = streamOf<float>(device, {1, 2});
  auto r = device.stream<float>({2});
  CHECK_THROWS_WITH(native_code::cancel(x, r),
                    Catch::Contains("native_code::cancel: it has no native code in "
                                    "__float128; compile its .sk file with skc --quad"));
}

}  // namespace
}  // namespace run_tests
