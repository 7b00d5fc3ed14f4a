// SPDX-License-Identifier: MIT
//
// Promises of --emit=bounds: no error of a kernel on the native device exceeds its bound, and the bounds are as close as those of the best
// published tool. Errors are measured against __float128, on random inputs and at the ends of their ranges. SK_FPBENCH_SAMPLES sets the
// number of samples, SK_FPBENCH_TABLE=1 prints the table of docs/accuracy.md.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "bounds/bounds.hpp"
#include "driver/compile.hpp"
#include "fpbench/examples.hpp"

namespace fpbench_tests {
namespace {

const skc::ir::Module& program() {
  static const skc::driver::Translation translation = [] {
    skc::driver::Options options;
    options.emit = skc::driver::Emit::Bounds;
    return skc::driver::translateText(options, "fpbench.sk", contents(SK_FPBENCH_FOLDER "/fpbench.sk"));
  }();
  REQUIRE(translation.module);
  return *translation.module;
}

skc::bounds::NumberBound boundOf(const Example& example, skc::bounds::Options options) {
  for (const Range& range : example.inputs) options.ranges.push_back({range.name, range.low, range.high});
  for (const skc::ir::Kernel& kernel : program().kernels) {
    if (kernel.name != example.kernel || kernel.isSynthesized || kernel.isPart) continue;
    const skc::bounds::KernelBounds bounds = skc::bounds::boundsOf(program(), kernel, options);
    CHECK(bounds.notBounded == "");
    REQUIRE(bounds.numbers.size() == 1);
    return bounds.numbers[0];
  }
  FAIL("no kernel " << example.kernel);
  return {};
}

/// With the options that skc has by default.
const skc::bounds::NumberBound& plainBoundOf(const Example& example) {
  static std::map<std::string, skc::bounds::NumberBound> known;
  const auto at = known.find(example.name);
  return at != known.end() ? at->second : known.emplace(example.name, boundOf(example, {})).first->second;
}

/// Random numbers in their ranges, a tenth of them at an end, and all corners.
std::vector<std::vector<double>> samplesOf(const Example& example, std::size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::vector<double>> samples(example.inputs.size());
  const std::size_t corners = std::size_t{1} << example.inputs.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Range& range = example.inputs[k];
      double x = std::clamp(range.low + unit(random) * (range.high - range.low), range.low, range.high);
      if (unit(random) < 0.1) x = unit(random) < 0.5 ? range.low : range.high;
      if (i < corners) x = (i >> k & 1) != 0 ? range.high : range.low;
      samples[k].push_back(x);
    }
  }
  return samples;
}

struct Measured {
  double absolute = 0, relative = 0;
  double low = INFINITY, high = -INFINITY;
};

Measured measure(const Example& example, std::size_t count) {
  sk::Device device = sk::Device::native();
  const std::vector<std::vector<double>> samples = samplesOf(example, count);
  std::vector<sk::Stream<double>> inputs;
  for (const std::vector<double>& values : samples) {
    inputs.push_back(device.stream<double>({static_cast<std::int64_t>(count)}));
    inputs.back().write(values);
  }
  auto result = device.stream<double>({static_cast<std::int64_t>(count)});
  example.run(inputs, result);
  const std::vector<double> computed = result.read();
  Measured measured;
  std::vector<Quad> x(samples.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = samples[k][i];
    const Quad exact = example.exact(x), difference = computed[i] - exact;
    const auto error = static_cast<double>(difference < 0 ? -difference : difference);
    measured.absolute = std::max(measured.absolute, error);
    measured.relative = std::max(measured.relative, error / std::fabs(static_cast<double>(exact)));
    measured.low = std::min(measured.low, static_cast<double>(exact));
    measured.high = std::max(measured.high, static_cast<double>(exact));
  }
  return measured;
}

std::size_t sampleCount() {
  const char* const given = std::getenv("SK_FPBENCH_SAMPLES");
  return given != nullptr ? std::strtoul(given, nullptr, 10) : 10'000;
}

std::string row(const Example& example, const Measured& measured, double bound, double onEqualTerms) {
  const std::string published = example.published == 0 ? "" : fmt::format("{:.3g}", example.published);
  const std::string equal = example.published == 0 ? "" : fmt::format("{:.3g}", onEqualTerms);
  return fmt::format("| {} | {:.2g} | {:.3g} | {} | {} |\n", example.name, measured.absolute, bound, equal,
                     published);
}

TEST_CASE("no error exceeds its bound, and bounds are near the best published ones") {
  std::string table;
  double logarithms = 0;
  int compared = 0;
  for (const Example& example : examples()) {
    INFO(example.name);
    const skc::bounds::NumberBound& bound = plainBoundOf(example);
    const Measured measured = measure(example, sampleCount());
    double allowed = bound.absolute;
    for (const skc::bounds::Jump& jump : bound.jumps) allowed += jump.change + bound.absolute;
    CHECK(measured.absolute <= allowed);
    CHECK(measured.absolute >= bound.absolute / 60);  // the bound is of this formula
    if (bound.relative) CHECK(measured.relative <= *bound.relative);
    CHECK(measured.low >= bound.range.low);
    CHECK(measured.high <= bound.range.high);
    double onEqualTerms = 0;
    if (example.published != 0) {
      skc::bounds::Options options;
      options.inputsAreReal = options.literalsAreDecimal = true;
      onEqualTerms = boundOf(example, options).absolute;
      CHECK(onEqualTerms <= 2 * example.published);
      logarithms += std::log(onEqualTerms / example.published);
      ++compared;
    }
    table += row(example, measured, bound.absolute, onEqualTerms);
  }
  const double mean = std::exp(logarithms / compared);
  if (std::getenv("SK_FPBENCH_TABLE") != nullptr) std::cout << table << "geometric mean " << mean << "\n";
  CHECK(mean <= 1.1);
}

/// The cells of the table's row for an example, without spaces.
std::vector<std::string> cellsOf(const std::string& document, const std::string& name) {
  const std::size_t at = document.find("\n| `" + name + "` |");
  std::vector<std::string> cells;
  if (at == std::string::npos) return cells;
  std::string cell;
  for (std::size_t i = at + 2; i < document.size() && document[i] != '\n'; ++i) {
    if (document[i] == '|') {
      cells.push_back(std::exchange(cell, {}));
    } else if (document[i] != ' ') {
      cell += document[i];
    }
  }
  return cells;
}

TEST_CASE("docs/accuracy.md has these bounds") {
  const std::string document = contents(SK_ACCURACY);
  for (const Example& example : examples()) {
    INFO(example.name);
    const std::vector<std::string> cells = cellsOf(document, example.name);
    REQUIRE(cells.size() == 5);  // one row for each example
    const double measured = std::stod(cells[1]), bound = std::stod(cells[2]);
    CHECK(plainBoundOf(example).absolute == Approx(bound).epsilon(0.02).scale(0));
    CHECK(measured <= 1.05 * bound);  // two digits
    if (example.published != 0)
      CHECK(std::stod(cells[4]) == Approx(example.published).epsilon(0.01).scale(0));
  }
}

}  // namespace
}  // namespace fpbench_tests
