// SPDX-License-Identifier: MIT
//
// Distances of results from the reference: sizes of errors for ordinary inputs, and counts for extreme
// inputs, for which sizes are not meaningful. Only computes numbers; measure.cpp maps an ErrorPlace to its
// inputs.
#pragma once

#include <cstddef>
#include <span>

#include "accuracy/file/call.hpp"

namespace sk_tool {

/// The location of an error among the results of one call.
struct ErrorPlace {
  std::size_t inputs = 0;  ///< number of the Inputs
  int draw = 0;
  std::size_t result = 0;
  std::size_t scalar = 0;
  double got = 0, wanted = 0;
};

/// Errors of ordinary results. Results that are not finite, or should not be, count as of the wrong class;
/// integers count as right or wrong.
class ErrorSizes {
 public:
  explicit ErrorSizes(std::span<const ResultScalar> scalars) : scalars_(scalars) {}

  void add(const Results& got, const Results& wanted, std::size_t inputs, int draw);
  /// "rel err" (infinite if a class is wrong), "max ulp", "mean ulp", "wrong class"; "wrong int" if there are
  /// integers.
  std::vector<Metric> metrics() const;
  /// The first result of a wrong class, else the largest error in ulp.
  const ErrorPlace& worst() const { return worst_; }

 private:
  std::span<const ResultScalar> scalars_;
  ErrorPlace worst_;
  double relative_ = 0, largest_ = -1, sum_ = 0;
  std::size_t numbers_ = 0, wrongClass_ = 0, wrongInteger_ = 0;
};

/// Results of extreme inputs: counts results with a scalar of another class than the reference's, and other
/// results with a scalar that is off by more than 1 %. Classes are NaN, each infinity, 0 and finite numbers.
class ErrorCounts {
 public:
  explicit ErrorCounts(std::span<const ResultScalar> scalars) : scalars_(scalars) {}

  void add(const Results& got, const Results& wanted, std::size_t inputs, int draw);

  std::size_t tried() const { return tried_; }
  std::size_t otherClass() const { return otherClass_; }
  std::size_t otherValue() const { return otherValue_; }
  /// The first result of another class, else the first of another value.
  const ErrorPlace& example() const { return otherClass_ > 0 ? classExample_ : valueExample_; }

 private:
  std::span<const ResultScalar> scalars_;
  std::size_t tried_ = 0, otherClass_ = 0, otherValue_ = 0;
  ErrorPlace classExample_, valueExample_;
};

}  // namespace sk_tool
