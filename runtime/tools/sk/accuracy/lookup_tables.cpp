// SPDX-License-Identifier: MIT
//
// A function that is computed, and looked up in tables of several sizes. The bound of a table's error is the
// runtime's prediction.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "accuracy/experiment.hpp"
#include "accuracy/lookup_tables.sk.hpp"
#include "accuracy/programs.hpp"
#include "info/numbers.hpp"

namespace sk_tool {

namespace {

constexpr float low = -8, high = 8;  // of lookup_tables.sk

/// The function's values are in [0, 1], so that its largest absolute errors are relative to 1.
Grade gradeOf(const std::vector<float>& results, const std::vector<double>& reference) {
  double largest = 0;
  double sum = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double error = std::fabs(results[i] - reference[i]);
    largest = std::isnan(error) ? HUGE_VAL : std::max(largest, error);
    sum += error;
  }
  return {.metrics = {{"max err", largest}, {"mean err", sum / static_cast<double>(results.size())}}};
}

/// The runtime's prediction for the function's table that was used last.
double predictedError(const sk::Device& device, const std::string& kernel) {
  const std::string function = "tables::" + kernel + "_";
  for (const sk::TableReport& report : device.tables()) {
    if (report.function == function) return report.predicted;
  }
  return 0;
}

}  // namespace

std::vector<Experiment> measureTables(sk::Device& device, const Measurement& measurement) {
  Numbers numbers(inputSeed);
  std::vector<float> x(measurement.size);
  for (float& v : x) v = numbers.linear(low, high);
  const sk::Shape shape{static_cast<std::int64_t>(x.size())};
  sk::Device exact = sk::Device::reference();
  auto exactInput = exact.stream<float>(shape);
  auto exactResult = exact.stream<float>(shape);
  exactInput.write(x);
  tables::compute(exactInput, exactResult);
  const std::vector<double> reference = exactResult.readReals();

  auto input = device.stream<float>(shape);
  auto result = device.stream<float>(shape);
  input.write(x);
  const auto computed = [&](const char* name, sk::Intrinsics intrinsics) {
    return Mode{name, [&, intrinsics] {
                  return Trial{
                      [&, intrinsics] { tables::compute.with({.intrinsics = intrinsics})(input, result); },
                      [&] { return gradeOf(result.read(), reference); }};
                }};
  };
  const auto looked = [&](const char* name, const std::string& kernelName, const auto& kernel) {
    return Mode{name, [&, kernelName] {
                  return Trial{[&] { kernel(input, result); },
                               [&, kernelName] {
                                 Grade grade = gradeOf(result.read(), reference);
                                 grade.bound = predictedError(device, kernelName);
                                 grade.isWithinBound = grade.error() <= *grade.bound;
                                 return grade;
                               }};
                }};
  };
  return {
      {.program = "tables",
       .data = "logistic",
       .about = fmt::format("1 / (1 + exp(-x)) of {} numbers in [{:g}, {:g}], in tables of so many intervals",
                            x.size(), low, high),
       .bounded = "max err",
       .rows = compareModes(
           device,
           {computed("accurate", sk::Intrinsics::Accurate), computed("fast", sk::Intrinsics::Fast),
            looked("linear, 64", "linear64", tables::linear64),
            looked("linear, 256", "linear256", tables::linear256),
            looked("linear, 1024", "linear1024", tables::linear1024),
            looked("linear, 4096", "linear4096", tables::linear4096),
            looked("cubic, 16", "cubic16", tables::cubic16), looked("cubic, 64", "cubic64", tables::cubic64),
            looked("cubic, 256", "cubic256", tables::cubic256)},
           measurement.rounds)}};
}

}  // namespace sk_tool
