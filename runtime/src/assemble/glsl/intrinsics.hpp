// SPDX-License-Identifier: MIT
//
// The meaning of a program::Intrinsic in a kernel's text: our own functions, which are the same on every device, or the
// device's functions under our names. Only those that a kernel calls are defined. Our own consist of parts, functions of
// one float, with their dependencies.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "sk/program.hpp"

namespace sk::assemble {

/// In order of definition: each needs only earlier ones.
enum class Part : std::uint8_t {
  WithSign,
  Scale,
  Mantissa,
  LogLimit,
  LogTail,
  Log,
  ExpScaled,
  Exp2Part,
  Cut,
  Power,
  ProductHigh,
  ReduceLarge,
  Reduce,
  Wave,
  AsinPart,
  AtanPart,
  Order,
  Min,
  Max,
  Saturate,
  Fmod,
  LengthScale,
  ErrorPart,
};

/// A set of parts, one bit per part.
using Parts = std::uint32_t;
template <class... P>
constexpr Parts parts(P... all) {
  return (Parts{0} | ... | (Parts{1} << static_cast<unsigned>(all)));
}

/// The parts of a set with their dependencies.
Parts withNeeded(Parts set);
/// Whether any of them calls sk_keep().
bool useExactFloats(Parts set);
std::string_view text(Part part);
inline constexpr unsigned partCount = static_cast<unsigned>(Part::ErrorPart) + 1;

/// For example "sk_sin".
std::string_view name(program::Intrinsic intrinsic);

struct IntrinsicTexts {
  std::string definitions;  ///< self-contained, except for own_arithmetic.hpp
  bool useExactFloats = false;  ///< they use sk_precise and sk_keep() of own_arithmetic.hpp
};

/// If accurate: within 3 ulp over the whole range, with the special cases of C99 (annex F) and, for minima
/// and maxima, of IEEE 754; docs/accuracy.md has the details of each. Otherwise the device's own.
IntrinsicTexts intrinsicTexts(std::span<const program::IntrinsicUse> uses, bool accurate);

}  // namespace sk::assemble
