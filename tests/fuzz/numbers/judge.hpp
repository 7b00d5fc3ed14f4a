// SPDX-License-Identifier: MIT
//
// Tells whether a number is one that a device may compute.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "numbers/bounds.hpp"
#include "numbers/case.hpp"
#include "support/function_oracle.hpp"
#include "support/oracle.hpp"

namespace fuzz::numbers {

/// The number, rounded to the nearest half, float, or pair of floats.
double toHalf(double x);
double toPair(double x);

bool isDenormal(double x);  ///< of a float
/// Whether devices that take denormal numbers as 0 may do so with this: a double a little below 2^-126 is rounded to that, or is 0 before.
bool mayBeFlushed(double x);

/// Whether two numbers are one: the same bits, but for those of NaN.
bool isSame(double a, double b);

/// What a function of an element may compute, on one device and in one precision.
class MapJudge {
 public:
  MapJudge(const Arithmetic& device, const sk::CallOptions& call) : arithmetic(device), options(call) {}

  /// `got` is this float.
  bool equals(float wanted, double got) const;
  /// `got` is this double, or the pair of floats nearest to it.
  bool equalsDouble(double wanted, double got) const;
  /// `got` is a quotient of floats, whose nearest float is `wanted`.
  bool isQuotient(float wanted, double divisor, double got) const;
  /// The argument as the device may read it: 0 for a denormal one.
  double flushed(double x) const {
    return arithmetic.flushesDenormals && isDenormal(x) ? std::copysign(0.0, x) : x;
  }
  /// Whether the device may compute anything at all as a quotient: GL promises nothing for divisors beyond 2^126.
  bool isAnyQuotient(double divisor) const;
  /// `got` is the result of an operation on floats, whose exact result is `wanted` (or rounded to 53 bits) in the precision of the
  /// call. `scale` is the size of what was rounded on the way, if that is larger.
  bool isRounded(double wanted, double got, double scale = 0) const;
  bool isFunction(const char* name, numerics::Unary function, double x, double got) const;
  bool isFunction(const char* name, numerics::Binary function, double x, double y, double got) const;
  bool isWideFunction(const char* name, numerics::Unary function, double x, double got) const;
  bool isWideFunction(const char* name, numerics::Binary function, double x, double y, double got) const;

  const Arithmetic& arithmetic;
  const sk::CallOptions& options;

 private:
  bool accepts(const char* name, double error, double nearest, double got) const;
  bool acceptsWide(const char* name, double error, double nearest, double got) const;
};

/// The sum of an accumulator of floats or doubles, and what a device may make of it.
class SumJudge {
 public:
  void add(double a, double b = 1);
  /// A term whose value the device may choose: nothing is known of the sum any more.
  void addUnknown() { isUnknown_ = true; }
  double terms() const { return terms_; }

  /// What is wrong with a result, or "". `facts` has the options of the call.
  std::string mistake(double got, SumFacts facts, const Arithmetic& arithmetic, bool startsFromZero) const;

 private:
  numerics::TrueSum sum_;
  double terms_ = 0;
  double flushed_ = 0;  ///< what is lost if denormal numbers are 0
  bool isUnknown_ = false, hasNan_ = false, hasPositive_ = false, hasNegative_ = false,
       hasOnlyNegativeZeros_ = true, mayBeNan_ = false;
};

}  // namespace fuzz::numbers
