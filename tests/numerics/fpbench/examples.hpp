// SPDX-License-Identifier: MIT
//
// The examples of fpbench.sk: their inputs, how to run them on a device, what they are in exact arithmetic, and the bounds that FPTaylor
// publishes.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <sk/sk.hpp>

namespace fpbench_tests {

__extension__ typedef __float128 Quad;

struct Range {
  std::string name;
  double low, high;
};

struct Example {
  std::string name, kernel;
  std::vector<Range> inputs;
  /// The smallest of the bounds that FPTaylor's repository has for its configurations, in benchmarks/real2float/results.txt and
  /// experiments/results/trans.txt of github.com/soarlab/FPTaylor at efbbc83; 0 if there is none. Its inputs and literals are real
  /// numbers, which the program rounds first.
  double published;
  std::function<void(const std::vector<sk::Stream<double>>& inputs, sk::Stream<double>& result)> run;
  std::function<Quad(std::span<const Quad> inputs)> exact;
};

const std::vector<Example>& examples();

/// A file's text.
std::string contents(const std::string& path);

}  // namespace fpbench_tests
