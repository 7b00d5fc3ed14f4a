// SPDX-License-Identifier: MIT
//
// The device's own functions and ours over ranges of arguments, with the kernel of `sk info`. The reference
// device runs it in double.
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "accuracy/experiment.hpp"
#include "accuracy/programs.hpp"
#include "info/device_info.hpp"
#include "info/functions.sk.hpp"
#include "info/numbers.hpp"
#include "sk/error_bounds.hpp"

namespace sk_tool {

namespace {

struct FunctionCase {
  const char* name;
  Function function;
  double low, high;
  double low2 = 1, high2 = 1;  ///< of the second argument
  double fastBound = 0;  ///< ulp that ARB_shader_precision guarantees for the device's own; 0: none
};

constexpr FunctionCase functionCases[] = {
    {.name = "exp", .function = f_exp, .low = -87, .high = 88, .fastBound = 3},
    {.name = "log", .function = f_log, .low = 1e-3, .high = 1e3, .fastBound = 3},
    {.name = "log near 1", .function = f_log, .low = 0.999, .high = 1.001, .fastBound = 3},
    {.name = "sin", .function = f_sin, .low = -100, .high = 100},
    {.name = "sin far", .function = f_sin, .low = 1e5, .high = 1e6},
    {.name = "cos", .function = f_cos, .low = -100, .high = 100},
    {.name = "tan", .function = f_tan, .low = -1.5, .high = 1.5},
    {.name = "asin", .function = f_asin, .low = -1, .high = 1},
    {.name = "atan", .function = f_atan, .low = -10, .high = 10},
    {.name = "tanh", .function = f_tanh, .low = -1, .high = 1},
    {.name = "pow", .function = f_pow, .low = 0.001, .high = 1000, .low2 = -10, .high2 = 10, .fastBound = 16},
};

/// The bound in ulp of our own function, which the first word of the name calls.
double accurateBoundOf(const FunctionCase& function, const sk::Device& device) {
  const std::string_view name = function.name;
  const sk::ErrorBound* bound =
      sk::errorBoundOf(name.substr(0, name.find(' ')), sk::BoundedType::Float,
                       isNative(device) ? sk::BoundedCode::Native : sk::BoundedCode::Glsl);
  return bound == nullptr ? 0 : bound->bound;
}

std::string aboutOf(const FunctionCase& function, std::size_t count) {
  std::string about = fmt::format("{} numbers in [{:g}, {:g}]", count, function.low, function.high);
  if (function.low2 != function.high2)
    about += fmt::format(", to powers in [{:g}, {:g}]", function.low2, function.high2);
  return about;
}

Experiment measureFunction(sk::Device& device, const Measurement& measurement, const FunctionCase& function) {
  Numbers numbers(inputSeed);
  std::vector<float> x(measurement.size);
  std::vector<float> y(measurement.size);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = numbers.linear(function.low, function.high);
    y[i] = numbers.linear(function.low2, function.high2);
  }
  std::vector<NamedInput> inputs{{"x", &x}};
  if (function.low2 != function.high2) inputs.push_back({"y", &y});
  const sk::Shape shape{static_cast<std::int64_t>(x.size())};
  const auto evaluate = [&](sk::Device& on, auto&& use) {
    auto xs = on.stream<float>(shape), ys = on.stream<float>(shape), rs = on.stream<float>(shape);
    xs.write(x);
    ys.write(y);
    use(xs, ys, rs);
  };
  std::vector<double> reference;
  sk::Device exact = sk::Device::reference();
  evaluate(exact, [&](auto& xs, auto& ys, auto& rs) {
    probes::function(function.function, xs, ys, rs);
    reference = rs.readReals();
  });

  Experiment experiment{.program = "transcendentals",
                        .data = function.name,
                        .about = aboutOf(function, x.size()),
                        .bounded = "max ulp"};
  evaluate(device, [&](auto& xs, auto& ys, auto& rs) {
    const auto mode = [&](const char* name, sk::Intrinsics intrinsics, double bound) {
      return Mode{name, [&, intrinsics, bound] {
                    return Trial{[&, intrinsics] {
                                   probes::function.with({.intrinsics = intrinsics})(function.function, xs,
                                                                                     ys, rs);
                                 },
                                 [&, bound] {
                                   Grade grade = gradeElements(rs.read(), reference, inputs);
                                   if (bound == 0) return grade;
                                   grade.bound = bound;
                                   grade.isWithinBound = grade.metrics[1].value <= bound;
                                   return grade;
                                 }};
                  }};
    };
    experiment.rows =
        compareModes(device,
                     {mode("fast", sk::Intrinsics::Fast, function.fastBound),
                      mode("accurate", sk::Intrinsics::Accurate, accurateBoundOf(function, device))},
                     measurement.rounds);
  });
  return experiment;
}

}  // namespace

std::vector<Experiment> measureTranscendentals(sk::Device& device, const Measurement& measurement) {
  std::vector<Experiment> experiments;
  for (const FunctionCase& function : functionCases)
    experiments.push_back(measureFunction(device, measurement, function));
  return experiments;
}

}  // namespace sk_tool
