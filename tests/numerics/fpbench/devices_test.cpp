// SPDX-License-Identifier: MIT
//
// Promises of --emit=bounds for floats: no error natively or of fragment programs, in any precision, exceeds the bound for that target and
// precision by more than its jumps. Errors are measured against the reference device, which computes in doubles.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "bounds/bounds.hpp"
#include "devices.sk.hpp"
#include "driver/compile.hpp"
#include "fpbench/examples.hpp"
#include "support/devices.hpp"

namespace fpbench_tests {
namespace {

using Floats = sk::Stream<float>;

struct Kernel {
  const char* name;
  void (*run)(const sk::CallOptions& options, const Floats& x, const Floats& y, const Floats& z, Floats& r);
};

#define SK_KERNEL(name)                                                                                      \
  {#name, [](const sk::CallOptions& options, const Floats& x, const Floats& y, const Floats& z, Floats& r) { \
     fpbench::name.with(options)(x, y, z, r);                                                                \
   }}

constexpr Kernel kernels[] = {SK_KERNEL(polynomial), SK_KERNEL(functions), SK_KERNEL(lengths),
                              SK_KERNEL(branches),   SK_KERNEL(clamped),   SK_KERNEL(solved),
                              SK_KERNEL(cancelled),  SK_KERNEL(matrices),  SK_KERNEL(halves),
                              SK_KERNEL(integers)};

constexpr Range ranges[] = {{"x", 0.25, 1.25}, {"y", 0.5, 1}, {"z", 0.75, 2}};
constexpr std::size_t count = 4000;

const skc::ir::Module& program() {
  static const skc::driver::Translation translation = [] {
    skc::driver::Options options;
    options.emit = skc::driver::Emit::Bounds;
    return skc::driver::translateText(options, "devices.sk", contents(SK_FPBENCH_FOLDER "/devices.sk"));
  }();
  REQUIRE(translation.module);
  return *translation.module;
}

skc::bounds::NumberBound boundOf(const Kernel& kernel, skc::bounds::Target target,
                                 skc::bounds::Precision precision) {
  skc::bounds::Options options;
  options.target = target;
  options.precision = precision;
  options.effort = 1'000'000;
  for (const Range& range : ranges) options.ranges.push_back({range.name, range.low, range.high});
  for (const skc::ir::Kernel& one : program().kernels) {
    if (one.name != kernel.name || one.isSynthesized || one.isPart) continue;
    const skc::bounds::KernelBounds bounds = skc::bounds::boundsOf(program(), one, options);
    REQUIRE(bounds.numbers.size() == 1);
    return bounds.numbers[0];
  }
  FAIL("no kernel " << kernel.name);
  return {};
}

std::vector<double> results(sk::Device& device, const Kernel& kernel, const sk::CallOptions& options) {
  std::mt19937 random(5);
  std::vector<Floats> inputs;
  for (const Range& range : ranges) {
    std::uniform_real_distribution<float> between(static_cast<float>(range.low),
                                                  static_cast<float>(range.high));
    std::vector<float> values(count);
    for (float& value : values) value = random() % 8 == 0 ? static_cast<float>(range.high) : between(random);
    inputs.push_back(device.stream<float>({count}));
    inputs.back().write(values);
  }
  auto result = device.stream<float>({count});
  kernel.run(options, inputs[0], inputs[1], inputs[2], result);
  return result.readReals();
}

/// `without`: a kernel that has no code, or no bound, in this precision.
void compare(sk::Device& device, skc::bounds::Target target, sk::Precision precision,
             skc::bounds::Precision bounded, double atLeast, std::string_view without = {}) {
  sk::Device reference = sk::Device::reference();
  for (const Kernel& kernel : kernels) {
    if (kernel.name == without) continue;
    INFO(kernel.name);
    const std::vector<double> exact = results(reference, kernel, {});
    const std::vector<double> computed = results(device, kernel, {.precision = precision});
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, std::fabs(computed[i] - exact[i]));
    const skc::bounds::NumberBound bound = boundOf(kernel, target, bounded);
    CHECK(bound.notBounded == "");
    double allowed = bound.absolute;
    for (const skc::bounds::Jump& jump : bound.jumps) allowed += jump.change + bound.absolute;
    CHECK(largest <= allowed);
    // The reference rounds to halves what a kernel does.
    if (kernel.name != std::string_view("halves")) CHECK(largest >= bound.absolute * atLeast);
  }
}

TEST_CASE("native errors are within their bounds, in each precision") {
  sk::Device& native = run_tests::device("native");
  using skc::bounds::Precision;
  using skc::bounds::Target;
  compare(native, Target::Native, sk::Precision::Single, Precision::Single, 0.02);
  compare(native, Target::Native, sk::Precision::Half, Precision::Half, 0.005, "cancelled");
  compare(native, Target::Native, sk::Precision::Double, Precision::Double, 0.005, "matrices");
}

TEST_CASE("errors of fragment programs are within their bounds") {
  sk::Device& drawn = run_tests::device("glsl330");
  using skc::bounds::Precision;
  using skc::bounds::Target;
  compare(drawn, Target::Fragment, sk::Precision::Single, Precision::Single, 0.005);
  compare(drawn, Target::Fragment, sk::Precision::Extended, Precision::Extended, 0, "matrices");
}

}  // namespace
}  // namespace fpbench_tests
