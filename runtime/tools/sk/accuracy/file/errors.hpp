// SPDX-License-Identifier: MIT
//
// Distances of results from the reference: sizes of errors for ordinary inputs, and counts for extreme
// inputs, for which sizes are not meaningful. Only computes numbers; measure.cpp maps an ErrorPlace to its
// inputs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

/// A result with a large error.
struct LargeError {
  ErrorPlace place;
  double ulps = 0;  ///< infinite if the result is of another class
};

/// What errors are relative to, and which of them is the worst.
enum class Scale : std::uint8_t {
  Result,  ///< the right result: of any size, as drawn inputs have
  RootMeanSquare,  ///< that of all right results, as in a shadow's report: of recorded inputs, some results may be next to 0
};

/// The errors of one scalar of the results.
struct ScalarErrors {
  Scale scale = Scale::Result;
  double relative = 0, absolute = 0, largest = 0;  ///< the last in ulp
  double sum = 0;  ///< of errors in ulp
  double squares = 0;  ///< the sum of those of right results
  double ofScale = 0;  ///< the largest absolute error over the root mean square, for Scale::RootMeanSquare
  double worstSize = 0;  ///< what makes an error the worst: ulp, or the absolute error
  std::size_t numbers = 0;  ///< results of the right class that are drawn
  std::size_t tried = 0, wrongClass = 0, wrongInteger = 0;
  ErrorPlace worst = {};  ///< the first result of a wrong class, else the largest error by worstSize

  /// For Scale::RootMeanSquare first "err/rms"; then "rel err" and "abs err" (infinite if a class is wrong), "max ulp" (infinite if no result is of the right class), "mean
  /// ulp", "wrong class".
  std::vector<Metric> metrics() const;
};

/// Errors of ordinary results. Results that are not finite, or should not be, count as of the wrong class;
/// integers count as right or wrong.
class ErrorSizes {
 public:
  explicit ErrorSizes(std::span<const ResultScalar> scalars, Scale scale = Scale::Result)
      : scalars_(scalars), errors_(scalars.size(), ScalarErrors{.scale = scale}) {}

  /// Adds the results of drawn inputs, or of inputs that were looked for, which do not count in means.
  void add(const Results& got, const Results& wanted, std::size_t inputs, int draw, bool isDrawn = true);
  /// The metrics over all scalars, with "wrong int" if there are integers.
  std::vector<Metric> metrics() const;
  /// The first result of a wrong class, else the largest error: in ulp, or over the root mean square.
  ErrorPlace worst() const { return total().worst; }
  const std::vector<ScalarErrors>& scalars() const { return errors_; }
  /// The largest errors, each of another element, the largest first.
  const std::vector<LargeError>& largest() const { return largest_; }

 private:
  ScalarErrors total() const;
  void keep(const ErrorPlace& place, double ulps);

  std::span<const ResultScalar> scalars_;
  std::vector<ScalarErrors> errors_;
  std::vector<LargeError> largest_;
};

/// The error of one result in ulp: infinite if it is of another class, or a wrong integer.
double ulpsOf(sk::program::Scalar scalar, double got, double wanted);

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
