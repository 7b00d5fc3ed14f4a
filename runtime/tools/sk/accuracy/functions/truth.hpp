// SPDX-License-Identifier: MIT
//
// The right values of the functions of one float, by the C library: in double, several at once where its vector functions are
// there (glibc's are within 4 ulp of a double, 2^-26 ulp of a float), and one by one in long double. Nothing here comes from
// the functions that are judged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "info/numbers.hpp"

namespace sk_tool {

/// A function of one real.
struct UnaryFunction {
  std::string_view name;
  Function number;  ///< in functions.sk
  void (*inDouble)(const float* x, double* values, std::size_t count);
  long double (*exactly)(long double x);
  double low, high;  ///< where half of its arguments are drawn from if not all can be tried
};

/// A function of two reals.
struct BinaryFunction {
  std::string_view name;
  Function number;
  long double (*exactly)(long double x, long double y);
  /// Where arguments are drawn from: x between the first two numbers, y between the others.
  std::vector<std::array<double, 4>> ranges;
};

/// All of info/functions.def that have one argument.
std::span<const UnaryFunction> unaryFunctions();
/// pow, atan2 and hypot.
std::span<const BinaryFunction> binaryFunctions();

struct ErrorSummary {
  double largest = 0;
  std::uint64_t notNearest = 0;  ///< results that are not the float nearest to the exact value
};

/// Computes the errors of floats in units in the last place (ulp) of the float nearest to the exact value. Infinities and
/// overflows count as 2^128. The error is infinite where only one of the two is NaN, or where the sign of a zero is wrong.
ErrorSummary errorsOf(const float* results, const double* exact, double* errors, std::size_t count);

/// The floats whose bits are first, first + every, ...
void floatsFrom(std::uint64_t first, std::uint64_t every, float* floats, std::size_t count);

}  // namespace sk_tool
