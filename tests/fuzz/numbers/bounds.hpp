// SPDX-License-Identifier: MIT
//
// What docs/accuracy.md promises: the largest errors of functions, in units in the last place, and of sums.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "sk/options.hpp"

namespace fuzz::numbers {

/// How a device computes, as far as promises depend on it.
struct Arithmetic {
  bool isNative = false;
  bool flushesDenormals = false;  ///< may take denormal numbers as 0
  bool hasPairs = false;  ///< doubles are pairs of floats
};

struct FunctionBounds {
  std::string_view name;
  double native, gl;  ///< of floats, in ulp
  double nativeDoubles;  ///< in ulp
  double glDoubles;  ///< relative, in 2^-53
  double pairs;  ///< relative: the exponent of 2
};

inline constexpr FunctionBounds functionBounds[] = {
    {"sin", 0.51, 1.7, 0.8, 2.9, -46},
    {"cos", 0.51, 1.7, 0.8, 2.9, -46},
    {"tan", 0.51, 2.9, 2.2, 4.6, -45.5},
    {"asin", 0.51, 1.8, 1.2, 4.3, -45.5},
    {"acos", 0.51, 1.4, 0.8, 3.8, -46},
    {"atan", 0.51, 2.3, 1.8, 3.4, -46},
    {"atan2", 0.51, 2.3, 1.9, 3.4, -46},
    {"sinh", 0.51, 1.7, 1.7, 2.9, -46.5},
    {"cosh", 0.51, 1.5, 1.2, 2.1, -46.5},
    {"tanh", 0.51, 1.4, 1.5, 3.1, -46},
    {"asinh", 0.51, 2.4, 1.7, 2.4, -46},
    {"acosh", 0.51, 2.4, 1.2, 2.9, -45.9},
    {"atanh", 0.51, 1.4, 1.8, 2.4, -46.5},
    {"exp", 0.51, 1.3, 0.8, 1.4, -47.5},
    {"exp2", 0.51, 1.3, 0.8, 2.1, -47.5},
    {"log", 0.51, 1.0, 0.9, 1.5, -46.5},
    {"log2", 0.51, 1.5, 0.9, 2.7, -46},
    {"log10", 0.51, 2.2, 0.8, 2.5, -45.9},
    {"pow", 0.51, 1.5, 0.8, 2.2, -47},
    {"mod", 0.5, 0.5, 0.5, 0.5, -44},
    {"fmod", 0, 0, 0, 0, -44},
    {"sqrt", 0.5, 2.5, 0.5, 1, -45},
    {"inversesqrt", 1.5, 2.5, 1.5, 2, -44},
    {"length", 2, 2, 2, 2, -44},
    {"normalize", 3, 3, 3, 3, -44},
};

inline const FunctionBounds& boundsOf(std::string_view name) {
  return *std::ranges::find(functionBounds, name, &FunctionBounds::name);
}

/// What the error of a sum depends on.
struct SumFacts {
  sk::Accumulate accumulate = sk::Accumulate::Compensated;
  sk::Precision precision = sk::Precision::Single;
  bool isScan = false;
  double elements = 0;
  double terms = 0;  ///< of all elements
  double magnitude = 0;  ///< sum of the magnitudes of the terms
  double sum = 0;
  bool areDoubles = false;  ///< the accumulator is a double
  bool areProducts = false;
};

/// The largest error of a sum that is not exact.
inline double boundOf(const SumFacts& facts, const Arithmetic& arithmetic) {
  constexpr double u = 0x1p-24;
  // An element adds its terms one after the other, and the elements form a tree.
  const double depth =
      std::log2(std::max(2.0, facts.elements)) + std::max(1.0, facts.terms / std::max(1.0, facts.elements));
  if (facts.areDoubles) {
    const double unit = arithmetic.hasPairs ? 0x1p-44 : 0x1p-53;
    return facts.terms * unit * facts.magnitude;
  }
  const double own = u * std::fabs(facts.sum) + (arithmetic.flushesDenormals ? 0x1p-126 : 0x1p-150);
  if (facts.precision == sk::Precision::Extended || facts.precision == sk::Precision::Double ||
      facts.accumulate == sk::Accumulate::Extended)
    return own + 0x1p-44 * depth * facts.magnitude;
  if (facts.accumulate == sk::Accumulate::Tree) return own + u * depth * facts.magnitude;
  return own + depth * depth * u * u * facts.magnitude;
}

}  // namespace fuzz::numbers
