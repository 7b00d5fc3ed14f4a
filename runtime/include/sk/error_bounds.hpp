// SPDX-License-Identifier: MIT
//
// The errors that functions of kernels may have, as data (error_bounds.def), and how each bound is known. docs/accuracy.md,
// `sk accuracy` and the tests read them from here.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace sk {

/// What a function computes in.
enum class BoundedType : std::uint8_t {
  Float,  ///< errors are in ulp: units in the last place of the float nearest to the exact value
  Double,  ///< natively in ulp of a double, in GLSL relative, in units of 2^-53
  Pair,  ///< a pair of floats; relative, in units of 2^-53
};

/// Whose function it is.
enum class BoundedCode : std::uint8_t {
  Native,  ///< skc's, in native code: the same bits on every CPU
  Glsl,  ///< ours in GLSL: without fused operations, rounded correctly, as on llvmpipe
};

/// How a bound is known.
enum class KnownBy : std::uint8_t {
  AllArguments,  ///< all 2^32 were tried: no error is larger (tests/numerics/exhaustive.json)
  Proof,  ///< by a formula, with its reason
  Samples,  ///< the largest error of some arguments, with room: larger ones may occur
};

struct ErrorBound {
  std::string_view function;
  BoundedType type;
  BoundedCode code;
  double bound;
  KnownBy known;
  double seen;  ///< the largest error that occurred
  std::uint64_t arguments;  ///< that were tried
  std::string_view reason;  ///< of a proof; else empty
};

inline constexpr ErrorBound errorBounds[] = {
#define SK_ALL_ARGUMENTS(function, type, code, bound, seen) \
  {#function,                                               \
   BoundedType::type,                                       \
   BoundedCode::code,                                       \
   bound,                                                   \
   KnownBy::AllArguments,                                   \
   seen,                                                    \
   std::uint64_t{1} << 32,                                  \
   ""},
#define SK_PROOF(function, type, code, bound, reason) \
  {#function, BoundedType::type, BoundedCode::code, bound, KnownBy::Proof, 0, 0, reason},
#define SK_SAMPLES(function, type, code, bound, seen, arguments) \
  {#function, BoundedType::type, BoundedCode::code, bound, KnownBy::Samples, seen, arguments, ""},
#include "sk/error_bounds.def"
#undef SK_ALL_ARGUMENTS
#undef SK_PROOF
#undef SK_SAMPLES
};

/// Null if there is none.
constexpr const ErrorBound* errorBoundOf(std::string_view function, BoundedType type, BoundedCode code) {
  for (const ErrorBound& one : errorBounds) {
    if (one.function == function && one.type == type && one.code == code) return &one;
  }
  return nullptr;
}

}  // namespace sk
