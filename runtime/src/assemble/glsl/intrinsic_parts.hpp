// SPDX-License-Identifier: MIT
//
// The building blocks of accurate intrinsics, functions of one float, with their dependencies.
#pragma once

#include <cstdint>
#include <string_view>

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
inline constexpr unsigned partCount = static_cast<unsigned>(Part::LengthScale) + 1;

}  // namespace sk::assemble
