// SPDX-License-Identifier: MIT
//
// What a bound is asked for: the ranges of inputs, and how the device computes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bounds/interval.hpp"
#include "ir/ir.hpp"

namespace skc::bounds {

enum class Target : std::uint8_t { Native, Fragment };
enum class Precision : std::uint8_t { Single, Half, Extended, Double };

std::string_view nameOf(Precision precision);

/// --range NAME=LOW:HIGH. The name is of a parameter, a member or a component of one: "x", "v.x", "ball.position".
struct NamedRange {
  std::string name;
  double low, high;
};

/// Reads "x=0:1" or "n=4"; throws std::invalid_argument with a message for people.
NamedRange parseRange(std::string_view text);

struct Options {
  std::vector<NamedRange> ranges = {};
  Target target = Target::Native;
  Precision precision = Precision::Single;
  bool isPrecisionGiven = false;  ///< else a kernel's declaration chooses before `precision` does
  bool hasVariants =
      false;  ///< the module has the variants for other precisions, or says why a kernel has none
  double elements = 0;  ///< that a reduce or scan folds; 0 if unknown
  std::size_t effort = 20'000'000;  ///< operations that the search may evaluate, about, for each bound

  // For comparisons with tools that take inputs and literals for real numbers, which the program rounds first.
  bool inputsAreReal = false;
  bool literalsAreDecimal = false;
};

/// Why a kernel has no bound: thrown while its graph is built.
class NotBounded : public std::runtime_error {
 public:
  explicit NotBounded(const std::string& reason, Loc place = {}) : std::runtime_error(reason), loc(place) {}
  Loc loc;
};

/// The range of a number that a kernel reads: that of the command line for its longest name given, else the parameter's own.
std::optional<Interval> rangeOf(const Options& options, const ir::KernelParam& param, std::string_view name);

}  // namespace skc::bounds
