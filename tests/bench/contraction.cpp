// SPDX-License-Identifier: MIT
#include "contraction.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "contraction.sk.hpp"
#include "rounds.hpp"
#include "side_by_side.hpp"

namespace bench {
namespace {

constexpr int extent = 1024;
constexpr double kernelBar = 1.03, sumBar = 1.02;

class Contractions {
 public:
  Contractions(const sk::DeviceOptions& options, std::string means, int rounds, double sampleMilliseconds,
               Report& report)
      : device_(options),
        means_(std::move(means)),
        rounds_(rounds),
        sample_(sampleMilliseconds),
        report_(report) {
    x_.write(ramp(std::int64_t{extent} * extent, 0.137F));
    y_.write(ramp(std::int64_t{extent} * extent, 0.371F));
  }

  template <class Kernel>
  void kernel(const std::string& name, const Kernel& kernel) {
    const auto contender = [&](sk::Contraction contraction) {
      return [&, chosen = kernel.with({.contraction = contraction})](int times) {
        for (int i = 0; i < times; ++i) chosen(0.5F, x_, y_, r_);
        device_.finish();
      };
    };
    add(name, contender(sk::Contraction::Exact), contender(sk::Contraction::Fast), kernelBar);
  }

  template <class Reduce>
  void sum(const std::string& name, const Reduce& reduce) {
    const auto contender = [&](sk::Contraction contraction) {
      const sk::CallOptions options{.accumulate = sk::Accumulate::Compensated, .contraction = contraction};
      return [&, chosen = reduce.with(options)](int times) {
        for (int i = 0; i < times; ++i) chosen(x_, y_);
      };
    };
    add("compensated " + name, contender(sk::Contraction::Exact), contender(sk::Contraction::Fast), sumBar);
  }

  /// The least and the largest median of the kernels.
  void summary() {
    report_.add({fmt::format("{}, least and largest of {} kernels", means_, medians_.size()),
                 "x",
                 {*std::ranges::min_element(medians_), quartilesOf(medians_).median,
                  *std::ranges::max_element(medians_)},
                 {},
                 {}});
  }

 private:
  void add(const std::string& name, const Contender& exact, const Contender& fast, double bar) {
    Comparison comparison;
    compare(exact, fast, rounds_, sample_, comparison, Time::Processor);
    const Quartiles ratio = quartilesOf(comparison.ratios);
    if (bar == kernelBar) medians_.push_back(ratio.median);
    report_.add({fmt::format("exact over fast, {}: {}", means_, name), "x", ratio, bar, {}});
  }

  sk::Device device_;
  std::string means_;
  int rounds_;
  double sample_;
  Report& report_;
  sk::Stream<float> x_ = device_.stream<float>({extent, extent}),
                    y_ = device_.stream<float>({extent, extent}),
                    r_ = device_.stream<float>({extent, extent});
  std::vector<double> medians_;
};

}  // namespace

void contractions(int rounds, double sampleMilliseconds, Report& report) {
  struct Means {
    sk::DeviceOptions options;
    const char* name;
  };
  const Means all[] = {{{.device = "software", .profile = "glsl330", .barrier = "precise"}, "precise, 3.30"},
                       {{.device = "software", .profile = "glsl330", .barrier = "xor"}, "xor, 3.30"},
                       {{.device = "software", .profile = "essl300", .barrier = "xor"}, "xor, ES 3.00"}};
  for (const auto& [options, name] : all) {
    using namespace ::contraction;
    Contractions c(options, name, rounds, sampleMilliseconds, report);
    c.kernel("saxpy", saxpy);
    c.kernel("scaled", scaled);
    c.kernel("stencil", stencil);
    c.kernel("reaction", reaction);
    c.kernel("edges", edges);
    c.kernel("polynomial", polynomial);
    c.kernel("quotient", quotient);
    c.kernel("shaded", shaded);
    c.kernel("moved", moved);
    c.kernel("iterated", iterated);
    c.kernel("attracted", attracted);
    c.summary();
    c.sum("sum", ::contraction::sum);
    c.sum("dot", dot_);
    c.sum("distance", distance_);
  }
}

}  // namespace bench
