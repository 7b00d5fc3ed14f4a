// SPDX-License-Identifier: MIT
//
// The largest difference between a device's results and a double-precision reference, and where it is,
// against a bound that every example states together with its reason.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace examples {

/// Half the distance from 1 to the next float: the largest relative error of one rounding.
inline constexpr double roundoff = 0x1p-24;

/// The 2-norm of a - b, which have the same length.
double distance(std::span<const double> a, std::span<const double> b);

/// The largest error of a device's sum of n numbers, as a part of the sum of their sizes: each pass of the
/// reduction adds up runs of 32, and n is run down to 1 in log32 n passes (N. Higham, "The accuracy of
/// floating point summation", 1993, section 3).
double sumBound(std::int64_t n);

class Verification {
 public:
  /// `what` was compared; `reason` says where `bound` comes from.
  Verification(std::string what, double bound, std::string reason);

  /// Takes in one result. The error is |got - expected| / scale; equal infinities and NaN on both sides
  /// are no error, NaN on one side is an infinite one. A scale of 0 asks for equality.
  void compare(std::int64_t place, double got, double expected, double scale = 1.0);
  /// The same for an error that was worked out elsewhere.
  void note(std::int64_t place, double error);

  /// Under the bound, and anything was compared at all.
  bool passed() const;
  double largest() const { return largest_; }
  double bound() const { return bound_; }
  const std::string& what() const { return what_; }

  /// "what: largest error 5.9e-08 at 17 of 1048576, allowed 1.2e-07 (reason): ok"
  std::string text() const;

 private:
  std::string what_;
  double bound_;
  std::string reason_;
  double largest_ = 0.0;
  std::int64_t place_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace examples
