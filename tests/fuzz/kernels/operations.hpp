// SPDX-License-Identifier: MIT
//
// Operators and intrinsics of random expressions: the spelling of each, its value for one component, and the bound of a
// float result.
#pragma once

#include <optional>

#include "kernels/model.hpp"
#include "random.hpp"

namespace fuzz {

/// `what` is the spelling: an operator such as "+", or the name of a function.
struct FloatOperation {
  const char* what;
  float (*value)(float, float);
  Bound (*bound)(Bound, Bound);
};
/// An operation on two floats. Its result is exact if its bound has at most exactBits bits.
const FloatOperation& randomFloatOperation(Random& random);

struct IntOperation {
  const char* what;
  std::uint32_t (*asInt)(std::uint32_t, std::uint32_t);
  std::uint32_t (*asUint)(std::uint32_t, std::uint32_t);
  enum class Right : std::uint8_t { Any, Shift, Divisor } right;
};
const IntOperation& randomIntOperation(Random& random);

struct FloatFunction {
  const char* what;
  float (*value)(float);
  Bound (*bound)(Bound);
};
const FloatFunction& randomFloatFunction(Random& random);

struct IntFunction {
  const char* what;
  std::uint32_t (*value)(std::uint32_t);
  bool forUint;
};
const IntFunction& randomIntFunction(Random& random);

struct Comparison {
  const char* what;
  bool (*ofFloats)(float, float);
  bool (*ofInts)(std::int32_t, std::int32_t);
  bool (*ofUints)(std::uint32_t, std::uint32_t);
};
const Comparison& randomComparison(Random& random);

}  // namespace fuzz
