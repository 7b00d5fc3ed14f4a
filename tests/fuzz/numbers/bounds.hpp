// SPDX-License-Identifier: MIT
//
// What docs/accuracy.md promises: the largest errors of functions, in units in the last place.
#pragma once

#include <string_view>

#include "sk/error_bounds.hpp"
#include "sk/sum_bounds.hpp"

namespace fuzz::numbers {

/// How a device computes, as far as promises depend on it.
struct Arithmetic : sk::SummingDevice {
  bool roundsQuotients =
      true;  ///< to the nearest float; else they are within 2.5 units in the last place, as GL says
};
using sk::SumFacts;
/// What a quotient within a function adds to its bound where quotients are not rounded correctly.
inline constexpr double unroundedQuotient = 1;

/// The largest error of a function, in the units of sk::ErrorBound: what runtime/include/sk/error_bounds.def has, or, of what it leaves out,
/// docs/accuracy.md.
inline double boundOf(std::string_view name, sk::BoundedType type, bool isNative) {
  const sk::ErrorBound* bound =
      sk::errorBoundOf(name, type, isNative ? sk::BoundedCode::Native : sk::BoundedCode::Glsl);
  if (bound != nullptr) return bound->bound;
  if (name == "length") return 2;
  if (name == "normalize") return 3;
  return 2.5;  // sqrt and inversesqrt of devices with GL
}

}  // namespace fuzz::numbers
