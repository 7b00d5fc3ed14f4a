// SPDX-License-Identifier: MIT
//
// The errors of a device's functions of one float over all 2^32 arguments, or every k-th. Prints nothing.
//
// The largest errors of a device's functions that are found among arguments drawn at random, and near the worst of them: for
// numbers of which there are too many to try all. Prints nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "accuracy/functions/truth.hpp"
#include "sk/device.hpp"

namespace sk_tool {

/// Arguments with a large error; `y` is 0 for functions of one argument.
struct SampledCase {
  double x = 0, y = 0, got = 0, wanted = 0;
  double error = 0;
};

struct SampledErrors {
  std::uint64_t arguments = 0;
  std::vector<SampledCase> worst = {};  ///< the largest error first

  double largest() const { return worst.empty() ? 0 : worst.front().error; }
};

/// Measures functions in single, extended or double precision. Errors of floats and of native doubles are in ulp, those of GL's
/// doubles and of pairs of floats in 2^-53 of the result, where it is not too small for the representation
/// (docs/accuracy.md, Functions of doubles). An eighth more arguments than `count` are drawn near the worst. `progress` is
/// called with the part that is done. Throws sk::Error if the device lacks the precision.
SampledErrors sample(sk::Device& device, const UnaryFunction& function, sk::Precision precision,
                     std::uint64_t count, const std::function<void(double)>& progress);
SampledErrors sample(sk::Device& device, const BinaryFunction& function, sk::Precision precision,
                     std::uint64_t count, const std::function<void(double)>& progress);

/// An argument with a large error.
struct SweptCase {
  float x = 0, got = 0;
  double wanted = 0;
  double error = 0;  ///< in ulp, computed in long double
};

struct FunctionErrors {
  std::uint64_t arguments = 0;
  std::uint64_t notNearest = 0;  ///< results that are not the float nearest to the exact value
  double largest = 0;  ///< in ulp; infinite if a result is of another class
  /// The largest errors above 0.5, the largest one first, of arguments that differ in more than their sign.
  std::vector<SweptCase> worst = {};
};

constexpr std::uint64_t allFloats = std::uint64_t{1} << 32;

/// Returns the errors of each device. All but native code may read a denormal argument as 0 and return 0 for a denormal
/// result. `progress` is called with the part that is done.
std::vector<FunctionErrors> sweep(std::span<sk::Device> devices, const UnaryFunction& function,
                                  std::uint64_t every, const std::function<void(double)>& progress);

}  // namespace sk_tool
