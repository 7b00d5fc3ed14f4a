// SPDX-License-Identifier: MIT
//
// Promises: native code rounds every operation unless a call, the source or a file asks for contraction. Then it fuses
// products with sums, but neither in library functions nor in compensated and exact sums.
#include <cmath>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "contraction.sk.hpp"
#include "sk/native/code.hpp"
#include "sk/sk.hpp"
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
    WARN("this CPU has no fused multiply-add, or the kernels are not optimised");
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
    WARN("this CPU has no fused multiply-add, or the kernels are not optimised");
    return;
  }
  CHECK(dotOf(sk::Accumulate::Tree, Contraction::Fast) != dotOf(sk::Accumulate::Tree, Contraction::Exact));
}

TEST_CASE("other devices take the choice, and ignore it") {
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
