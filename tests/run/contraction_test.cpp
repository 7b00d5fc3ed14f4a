// SPDX-License-Identifier: MIT
//
// Promises: native code rounds every operation unless a call, the source or a file asks for contraction. Then it fuses
// products with sums, but neither in library functions nor in compensated and exact sums.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "contraction.sk.hpp"
#include "sk/native/code.hpp"
#include "sk/sk.hpp"
#include "skip.hpp"
#include "support/configuration_file.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using sk::Contraction;

constexpr std::int64_t count = 1000;  // several vectors and a remainder

/// Whether native code uses fused operations on this CPU, where it may.
bool codeFuses() {
#if defined(SK_FUSES_NOTHING)
  return false;
#elif defined(__x86_64__)
  return sk::native::levelOfHardware() >= sk::native::Level::V3;
#elif defined(__aarch64__)
  return true;
#else
  return false;
#endif
}

/// x, y = x * x rounded to float, and what that rounding loses, which is x * x - y if it is fused.
struct Squares {
  std::vector<float> x, y, lost;

  Squares() {
    for (std::int64_t i = 0; i < count; ++i) {
      const float root = 1 + static_cast<float>(i) / 999;
      const float square = static_cast<float>(double{root} * root);
      x.push_back(root);
      y.push_back(square);
      lost.push_back(std::fma(root, root, -square));
    }
  }
};

sk::Stream<float> streamOf(sk::Device& device, const std::vector<float>& values) {
  auto stream = device.stream<float>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

/// The results of a kernel of x and y.
template <class Kernel>
std::vector<float> resultsOf(sk::Device& device, const Kernel& kernel, const Squares& in) {
  auto r = device.stream<float>({count});
  kernel(streamOf(device, in.x), streamOf(device, in.y), r);
  return r.read();
}

const std::vector<float> zeros(count, 0.0F);

TEST_CASE("every operation is rounded by default") {
  const Squares in;
  sk::Device device = sk::Device::native();
  CHECK(resultsOf(device, contraction::residue, in) == zeros);
  CHECK(resultsOf(device, contraction::residueByCall, in) == zeros);
  CHECK(resultsOf(device, contraction::residue.with({.contraction = Contraction::Exact}), in) == zeros);
  CHECK(resultsOf(device, contraction::fusedResidue.with({.contraction = Contraction::Exact}), in) == zeros);
}

TEST_CASE("products and sums are fused where a call, the source or a file asks for it") {
  if (!codeFuses()) {
    skip("this CPU has no fused multiply-add, or the kernels are not optimised");
    return;
  }
  const Squares in;
  sk::Device device = sk::Device::native();
  constexpr sk::CallOptions fast{.contraction = Contraction::Fast};
  CHECK(resultsOf(device, contraction::residue.with(fast), in) == in.lost);
  CHECK(resultsOf(device, contraction::residueByCall.with(fast), in) == in.lost);
  CHECK(resultsOf(device, contraction::fusedResidue, in) == in.lost);

  const ConfigurationFile file(
      "[kernels.\"contraction::residue\"]\ncontraction = \"fast\"\n"
      "[kernels.\"contraction::fusedResidue\"]\ncontraction = \"exact\"\n");
  sk::Device configured({.device = "native", .configuration = file.path});
  CHECK(resultsOf(configured, contraction::residue, in) == in.lost);
  CHECK(resultsOf(configured, contraction::fusedResidue, in) == zeros);
  CHECK(resultsOf(configured, contraction::residue.with({.contraction = Contraction::Exact}), in) == zeros);
}

TEST_CASE("functions of the library have the same bits, contracted or not") {
  const Squares in;
  sk::Device device = sk::Device::native();
  const auto x = streamOf(device, in.x);
  auto plain = device.stream<float>({count}), fast = device.stream<float>({count});
  contraction::sine(x, plain);
  contraction::scaledSine.with({.contraction = Contraction::Fast})(x, 1.0F, 0.0F, fast);
  CHECK(fast.read() == plain.read());
}

TEST_CASE("sums are contracted in a plain tree alone") {
  const Squares in;
  sk::Device device = sk::Device::native();
  const auto x = streamOf(device, in.x), y = streamOf(device, in.lost);
  const auto dotOf = [&](sk::Accumulate accumulate, Contraction contraction) {
    return contraction::dot.with({.accumulate = accumulate, .contraction = contraction})(x, y);
  };
  for (const sk::Accumulate accumulate :
       {sk::Accumulate::Default, sk::Accumulate::Compensated, sk::Accumulate::Exact}) {
    CHECK(dotOf(accumulate, Contraction::Fast) == dotOf(accumulate, Contraction::Exact));
  }
  if (!codeFuses()) {
    skip("this CPU has no fused multiply-add, or the kernels are not optimised");
    return;
  }
  CHECK(dotOf(sk::Accumulate::Tree, Contraction::Fast) != dotOf(sk::Accumulate::Tree, Contraction::Exact));
}

TEST_CASE("fma is fused where its product has another use") {
  if (!codeFuses()) {
    skip("this CPU has no fused multiply-add, or the kernels are not optimised");
    return;
  }
  sk::Device device = sk::Device::native();
  const std::vector<float> a(count, 1 + 0x1p-23F), c(count, -(1 + 0x1p-22F));
  auto r = device.stream<float>({count}), s = device.stream<float>({count});
  contraction::twice.with({.contraction = Contraction::Fast})(streamOf(device, a), streamOf(device, a),
                                                              streamOf(device, c), r, s);
  CHECK(r.read() == std::vector<float>(count, 0x1p-46F));
  CHECK(s.read() == std::vector<float>(count, std::fma(a[0], a[0], -c[0])));
}

/// `count` floats in [1, 100), the same in every run.
std::vector<float> someFloats(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> list;
  for (std::int64_t i = 0; i < count; ++i)
    list.push_back(1 + 99 * static_cast<float>(random() >> 8) * 0x1p-24F);
  return list;
}

std::vector<sk::float4> someVectors(unsigned seed) {
  const std::vector<float> x = someFloats(seed), y = someFloats(seed + 1), z = someFloats(seed + 2);
  std::vector<sk::float4> list;
  for (std::size_t i = 0; i < x.size(); ++i) list.push_back({x[i], y[i], z[i], x[x.size() - 1 - i]});
  return list;
}

/// The bits of what kernels of float arithmetic compute.
struct Written {
  std::vector<std::vector<sk::float4>> vectors;
  std::vector<std::vector<float>> floats;

  Written(sk::Device& device, const sk::CallOptions& options) {
    const auto a = streamOf(device, someFloats(1)), b = streamOf(device, someFloats(2)),
               c = streamOf(device, someFloats(3));
    auto p = device.stream<sk::float4>({count}), q = device.stream<sk::float4>({count}),
         r = device.stream<sk::float4>({count}), s = device.stream<sk::float4>({count});
    contraction::written.with(options)(a, b, c, p, q, r, s);
    for (const auto* each : {&p, &q, &r, &s}) vectors.push_back(each->read());
    auto u = device.stream<sk::float4>({count}), v = device.stream<sk::float4>({count});
    u.write(someVectors(4));
    v.write(someVectors(7));
    auto f = device.stream<float>({count});
    vectors::writtenOfVectors.with(options)(u, v, a, p, q, r, f);
    for (const auto* each : {&p, &q, &r}) vectors.push_back(each->read());
    floats.push_back(f.read());
    auto w = device.stream<sk::float4>({count});
    w.write(someVectors(10));
    vectors::writtenOfMatrices.with(options)(u, v, w, p, q, r, s);
    for (const auto* each : {&p, &q, &r, &s}) vectors.push_back(each->read());
    vectors::writtenOfArguments.with(options)(u, v, a, p);
    vectors.push_back(p.read());
    auto pushes = device.stream<float>({0});
    contraction::pushed.with(options)(a, pushes);
    floats.push_back(pushes.read());
  }
};

/// How many results differ, by component; empty if all have the same bits.
std::string differences(const Written& a, const Written& b) {
  std::string text;
  for (std::size_t i = 0; i < a.vectors.size(); ++i) {
    std::array<int, 4> wrong{};
    for (std::size_t k = 0; k < a.vectors[i].size(); ++k) {
      const sk::float4 &x = a.vectors[i][k], &y = b.vectors[i][k];
      wrong[0] += x.x != y.x;
      wrong[1] += x.y != y.y;
      wrong[2] += x.z != y.z;
      wrong[3] += x.w != y.w;
    }
    if (wrong == std::array<int, 4>{}) continue;
    text += "vectors " + std::to_string(i) + ":";
    for (const int each : wrong) text += " " + std::to_string(each);
    text += "; ";
  }
  for (std::size_t i = 0; i < a.floats.size(); ++i)
    if (a.floats[i] != b.floats[i]) text += "floats " + std::to_string(i) + "; ";
  return text;
}

TEST_CASE("operations are computed as they are written, with the bits of native code") {
  sk::Device native = sk::Device::native();
  const Written expected(native, {});
  for (const char* profile : {"glsl330", "glsl430", "essl300"}) {
    INFO(profile);
    sk::Device& device = run_tests::device(profile);
    CHECK(differences(Written(device, {}), expected) == "");
  }
  INFO("glsl330 without `precise`");
  sk::Device barred({.device = "software", .profile = "glsl330", .barrier = "xor"});
  CHECK(differences(Written(barred, {}), expected) == "");
}

bool isSame(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

/// What the kernels of known values compute.
std::vector<float> known(sk::Device& device) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> x, y;
  for (const float a : {0.0F, -0.0F, 1.5F, -1.5F, infinity, -infinity}) {
    for (const float b : {0.0F, -0.0F, 2.5F, -2.5F, infinity}) {
      x.push_back(a);
      y.push_back(b);
    }
  }
  const auto size = static_cast<std::int64_t>(x.size());
  auto p = device.stream<sk::float4>({size}), q = device.stream<sk::float4>({size}),
       r = device.stream<sk::float4>({size}), s = device.stream<sk::float4>({size});
  contraction::known(streamOf(device, x), streamOf(device, y), 0.0F, p, q, r, s);
  std::vector<float> values;
  for (const auto* each : {&p, &q, &r, &s}) {
    for (const sk::float4& one : each->read()) values.insert(values.end(), {one.x, one.y, one.z, one.w});
  }
  return values;
}

/// What the kernel computes of normalized integers.
std::vector<float> converted(sk::Device& device) {
  std::vector<sk::unorm16> given;
  for (int i = 0; i < 65536; i += 7) given.push_back(sk::unorm16(static_cast<float>(i) / 65535));
  const auto size = static_cast<std::int64_t>(given.size());
  auto x = device.stream<sk::unorm16>({size}), r = device.stream<sk::unorm16>({size});
  auto s = device.stream<float>({size});
  x.write(given);
  contraction::converted(x, r, s);
  std::vector<float> values = s.read();
  for (const sk::unorm16 one : r.read()) values.push_back(static_cast<float>(one));
  return values;
}

std::vector<float> copied(sk::Device& device) {
  auto p = device.stream<sk::float4>({count});
  auto q = device.stream<float>({count}), r = device.stream<float>({0});
  contraction::copied(streamOf(device, someFloats(1)), streamOf(device, someFloats(2)), p, q, r);
  std::vector<float> values = q.read();
  for (const sk::float4& one : p.read()) values.insert(values.end(), {one.x, one.y, one.z, one.w});
  const std::vector<float> pushes = r.read();
  values.insert(values.end(), pushes.begin(), pushes.end());
  return values;
}

TEST_CASE("zeros and other values that compilers know change no bits, nor do conversions and copies") {
  sk::Device native = sk::Device::native();
  sk::Device barred({.device = "software", .profile = "glsl330", .barrier = "xor"});
  const auto compare = [&](std::vector<float> (*values)(sk::Device&)) {
    const std::vector<float> expected = values(native);
    const auto differences = [&](sk::Device& device) {
      const std::vector<float> found = values(device);
      REQUIRE(found.size() == expected.size());
      std::vector<std::size_t> places;
      for (std::size_t i = 0; i < found.size(); ++i)
        if (!isSame(found[i], expected[i])) places.push_back(i);
      return places;
    };
    const std::vector<std::size_t> none;
    for (const char* profile : {"glsl330", "glsl430", "essl300"}) {
      INFO(profile);
      CHECK(differences(run_tests::device(profile)) == none);
    }
    INFO("glsl330 without `precise`");
    CHECK(differences(barred) == none);
  };
  compare(known);
  compare(converted);
  compare(copied);
}

TEST_CASE("devices that contract by themselves may do so where a call allows it") {
  const Squares in;
  onEveryTarget([&](sk::Device& device) {
    const auto results = resultsOf(device, contraction::residue.with({.contraction = Contraction::Fast}), in);
    for (std::size_t i = 0; i < results.size(); ++i) {
      const bool isEither = results[i] == 0 || results[i] == in.lost[i];
      CHECK(isEither);
    }
  });
  sk::Device reference = sk::Device::reference();
  CHECK(resultsOf(reference, contraction::residue.with({.contraction = Contraction::Fast}), in) ==
        resultsOf(reference, contraction::residue, in));
}

}  // namespace
}  // namespace run_tests
