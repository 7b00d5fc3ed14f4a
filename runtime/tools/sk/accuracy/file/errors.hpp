// SPDX-License-Identifier: MIT
//
// How far results are from the reference: sizes of errors for ordinary inputs, and counts for extreme ones, among
// which errors have no size. Numbers only: what inputs belong to a place, measure.cpp knows.
#pragma once

#include <cstddef>
#include <span>

#include "accuracy/file/call.hpp"

namespace sk_tool {

/// Of the results of one call.
struct ErrorPlace {
  std::size_t inputs = 0;  ///< number of the Inputs
  int draw = 0;
  std::size_t result = 0;
  std::size_t scalar = 0;
  double got = 0, wanted = 0;
};

/// Errors of ordinary results. Those that are no finite numbers, or should be none, count as of the wrong class, and
/// integers as right or wrong.
class ErrorSizes {
 public:
  explicit ErrorSizes(std::span<const ResultScalar> scalars) : scalars_(scalars) {}

  void add(const Results& got, const Results& wanted, std::size_t inputs, int draw);
  /// "rel err" (infinite where a class is wrong), "max ulp", "mean ulp", "wrong class", and where there are integers "wrong int".
  std::vector<Metric> metrics() const;
  /// Of the first result of a wrong class, else of the largest error in ulp.
  const ErrorPlace& worst() const { return worst_; }

 private:
  std::span<const ResultScalar> scalars_;
  ErrorPlace worst_;
  double relative_ = 0, largest_ = -1, sum_ = 0;
  std::size_t numbers_ = 0, wrongClass_ = 0, wrongInteger_ = 0;
};

/// Results of extreme inputs: how many have a scalar of another class than the reference's, and of the others, how many one
/// that is off by more than 1 %. Classes are NaN, each infinity, 0 and the finite.
class ErrorCounts {
 public:
  explicit ErrorCounts(std::span<const ResultScalar> scalars) : scalars_(scalars) {}

  void add(const Results& got, const Results& wanted, std::size_t inputs, int draw);

  std::size_t tried() const { return tried_; }
  std::size_t otherClass() const { return otherClass_; }
  std::size_t otherValue() const { return otherValue_; }
  /// The first of another class, else the first of another value.
  const ErrorPlace& example() const { return otherClass_ > 0 ? classExample_ : valueExample_; }

 private:
  std::span<const ResultScalar> scalars_;
  std::size_t tried_ = 0, otherClass_ = 0, otherValue_ = 0;
  ErrorPlace classExample_, valueExample_;
};

}  // namespace sk_tool
