// SPDX-License-Identifier: MIT
//
// Numbers on which a fold is tried. They are the same in every run of skc.
#pragma once

#include <array>
#include <cstdint>

#include "ir/type.hpp"

namespace skc {

/// What an author may know about the numbers of an element.
enum class SampleKind : std::uint8_t {
  Positive,
  Signed,  ///< whole numbers
  Few,  ///< 1, 2 or 3, so that many are equal
  Unit,  ///< between 0 and 1; integers are 0 or 1
  Ascending,  ///< within an element, such as the bounds of an interval
  Descending,
  Equal,  ///< within an element
  Powers,  ///< of two
  OneHot,  ///< all numbers of an element but one are 0
};
/// In the order in which they are tried. The first three are what most programs have.
inline constexpr std::array sampleKinds = {
    SampleKind::Positive,   SampleKind::Signed, SampleKind::Few,    SampleKind::Unit,  SampleKind::Ascending,
    SampleKind::Descending, SampleKind::Equal,  SampleKind::Powers, SampleKind::OneHot};

/// Says which number is wanted.
struct SampleNumber {
  SampleKind kind;
  int sample;
  int number;  ///< differs for all numbers of a sample
  int element;  ///< what the number belongs to: the same for all numbers of one element
  int within, count;  ///< the number's position in its element, and how many numbers that has
};

/// A number that neither overflows nor vanishes. Sums and products of a few such numbers are exact.
double sampleOf(ir::Scalar scalar, const SampleNumber& wanted);

}  // namespace skc
