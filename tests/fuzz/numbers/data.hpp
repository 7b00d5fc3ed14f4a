// SPDX-License-Identifier: MIT
//
// Numbers made to hurt.
#pragma once

#include <cstddef>

#include "numbers/operations.hpp"
#include "random.hpp"

namespace fuzz::numbers {

/// Two ranges of exponents: those of floats, and some that doubles have besides.
struct Range {
  int least, most;  ///< exponents of 2
  int digits;  ///< bits of the mantissas
};
inline constexpr Range floatRange{-149, 127, 24}, doubleRange{-240, 240, 53};

/// Elements of an accumulator, made such that sums of them are hard. There are several kinds of such numbers.
inline constexpr std::size_t kindsOfTerms = 12;
Values terms(Random& random, std::size_t count, const Range& range, std::size_t kind);
/// Arguments of functions.
Values arguments(Random& random, std::size_t count, Data data, bool areDoubles);
Values integers(Random& random, std::size_t count, bool areSigned);

}  // namespace fuzz::numbers
