// SPDX-License-Identifier: MIT
#include "functions.hpp"

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "functions.sk.hpp"
#include "rounds.hpp"

namespace bench {
namespace {

constexpr int side = 512;

class Functions {
 public:
  Functions(sk::Device& device, int rounds, double sampleMilliseconds, Report& report)
      : device_(device), rounds_(rounds), sample_(sampleMilliseconds), report_(report) {}

  /// Of arguments in [low, high].
  template <class Kernel>
  void measure(const std::string& name, const Kernel& kernel, double low = 0, double high = 1) {
    std::vector<sk::float4> values;
    for (int i = 0; i < side * side; ++i) {
      const auto at = [&](double step) {
        return static_cast<float>(low + (high - low) * std::fmod(i * step, 1.0));
      };
      values.push_back({at(0.137), at(0.371), at(0.733), at(0.917)});
    }
    auto x = device_.stream<sk::float4>({side, side});
    auto r = device_.stream<sk::float4>({side, side});
    x.write(values);
    const auto contender = [&](sk::Intrinsics intrinsics) {
      return [&, chosen = kernel.with({.intrinsics = intrinsics})](int times) {
        for (int i = 0; i < times; ++i) chosen(x, r);
        device_.finish();
      };
    };
    Comparison comparison;
    compare(contender(sk::Intrinsics::Accurate), contender(sk::Intrinsics::Fast), rounds_, sample_,
            comparison);
    report_.add(
        {fmt::format("accurate {} over the device's", name), "x", quartilesOf(comparison.ratios), {}, {}});
  }

 private:
  sk::Device& device_;
  int rounds_;
  double sample_;
  Report& report_;
};

}  // namespace

void functions(sk::Device& device, int rounds, double sampleMilliseconds, Report& report) {
  using namespace ::functions;
  Functions f(device, rounds, sampleMilliseconds, report);
  f.measure("sin", run_sin, -3, 3);
  f.measure("sin of 1e6", run_sin, -1e6, 1e6);
  f.measure("cos", run_cos, -3, 3);
  f.measure("tan", run_tan, -1.5, 1.5);
  f.measure("asin", run_asin, -1, 1);
  f.measure("acos", run_acos, -1, 1);
  f.measure("atan", run_atan, -10, 10);
  f.measure("atan2", run_atan2, -10, 10);
  f.measure("sinh", run_sinh, -10, 10);
  f.measure("cosh", run_cosh, -10, 10);
  f.measure("tanh", run_tanh, -10, 10);
  f.measure("asinh", run_asinh, -10, 10);
  f.measure("acosh", run_acosh, 1, 10);
  f.measure("atanh", run_atanh, -1, 1);
  f.measure("exp", run_exp, -80, 80);
  f.measure("exp2", run_exp2, -80, 80);
  f.measure("log", run_log, 0, 10);
  f.measure("log2", run_log2, 0, 10);
  f.measure("log10", run_log10, 0, 10);
  f.measure("pow", run_pow, 0, 10);
  f.measure("log1p", run_log1p, -1, 10);
  f.measure("expm1", run_expm1, -80, 80);
  f.measure("hypot", run_hypot, -10, 10);
  f.measure("cbrt", run_cbrt, -10, 10);
  f.measure("min", run_min, -1, 1);
  f.measure("max", run_max, -1, 1);
  f.measure("clamp", run_clamp, -1, 1);
  f.measure("saturate", run_saturate, -1, 2);
  f.measure("fract", run_fract, -10, 10);
  f.measure("mod", run_mod, 1, 100);
  f.measure("fmod", run_fmod, 1, 100);
  f.measure("mix", run_mix);
  f.measure("smoothstep", run_smoothstep);
  f.measure("length", run_length, -1, 1);
  f.measure("normalize", run_normalize, -1, 1);
}

void warmStart(const std::string& device, int rounds, Report& report) {
  using namespace ::functions;
  std::vector<double> milliseconds;
  for (int round = 0; round <= rounds; ++round) {
    sk::Device made(device);
    auto x = made.stream<sk::float4>({8, 8});
    auto r = made.stream<sk::float4>({8, 8});
    x.write(std::vector<sk::float4>(64, {0.1f, 0.2f, 0.3f, 0.4f}));
    const auto start = std::chrono::steady_clock::now();
    const auto call = [&](const auto&... kernels) { (kernels(x, r), ...); };
    call(run_sin, run_cos, run_tan, run_asin, run_acos, run_atan, run_atan2, run_sinh, run_cosh, run_tanh,
         run_asinh, run_acosh, run_atanh, run_exp, run_exp2, run_log, run_log2, run_log10, run_pow, run_fmod);
    made.finish();
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    if (round > 0) milliseconds.push_back(taken.count());  // the first may have compiled
  }
  report.add({"twenty kernels on a new device, compiled before", "ms", quartilesOf(milliseconds), 100.0, {}});
}

}  // namespace bench
