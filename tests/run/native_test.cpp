// SPDX-License-Identifier: MIT
//
// Promises: native code needs no GL; the reference computes in double and takes the same calls. What arithmetic
// gives at its extremes is the business of tests/numerics.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <catch2/catch.hpp>

#include "native.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using namespace native_code;

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values) {
  auto stream = device.stream<T>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

TEST_CASE("the native device says what it is") {
  sk::Device device = sk::Device::native();
  CHECK(device.name() == "native");
  CHECK(device.profile() == "native");
  CHECK(device.isSoftware());
  CHECK(sk::Device("reference").name() == "reference (native, double)");
  auto stream = device.stream<float>({3});
  CHECK_THROWS_WITH(stream.texture(), Catch::Contains("no textures") && Catch::Contains("read()"));
}

TEST_CASE("the reference computes in double, of the floats that it is given") {
  sk::Device device = sk::Device::reference();
  const std::vector<float> x{0.1F, 3.0F, 1e6F};
  const auto in = streamOf(device, x);
  auto r = device.stream<float>({3});
  cancel(in, r);
  const std::vector<double> exact = r.readReals();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double v = x[i];
    CHECK(exact[i] == (v + double{1e-9F}) - v + v * v * double{1e-12F});
    CHECK(r.read()[i] == static_cast<float>(exact[i]));
  }
  auto twice = device.stream<float>({3});
  cancel(r, twice);  // streams hold doubles between calls
  CHECK(twice.readReals()[0] == (exact[0] + double{1e-9F}) - exact[0] + exact[0] * exact[0] * double{1e-12F});
}

TEST_CASE("sums have the error of a tree, not of a loop") {
  const std::int64_t n = (1 << 20) + 7;
  const std::vector<float> x(static_cast<std::size_t>(n), 0.1F);
  sk::Device device = sk::Device::native();
  sk::Device reference = sk::Device::reference();
  const double exact = 0.1F * static_cast<double>(n);
  const float total = sum(streamOf(device, x));
  // 16 elements one after the other, then pairs: 15 + 17 roundings of half an ulp
  CHECK(std::fabs(total - exact) <= 32 * 0x1p-24 * exact);
  CHECK(sum(streamOf(reference, x)) == static_cast<float>(exact));
}

TEST_CASE("a stream that is read at other places is read as it was") {
  sk::Device device = sk::Device::native();
  auto a = streamOf<float>(device, {1, 2, 3, 4});
  shift(a, 0.5F, a);
  CHECK(a.read() == std::vector<float>{2.5F, 3.5F, 4.5F, 1.5F});
}

TEST_CASE("reals are read of floats alone") {
  sk::Device device = sk::Device::native();
  auto ints = device.stream<std::int32_t>({2});
  CHECK_THROWS_WITH(ints.readReals(), Catch::Contains("int") && Catch::Contains("read()"));
  CHECK(device.stream<sk::float2>({0}).readReals().empty());
  sk::Device& gl = run_tests::device("glsl330");
  CHECK(streamOf<sk::float2>(gl, {{1, 2}, {3, 4}}).readReals() == std::vector<double>{1, 2, 3, 4});
}

}  // namespace
}  // namespace run_tests
