// SPDX-License-Identifier: MIT
//
// The functions of one and of two numbers that kernels call, over intervals: values, derivatives, and where they are defined. Values
// come from the C library, whose errors glibc's manual gives as at most 5 units in the last place; each end moves outward by more.
#pragma once

#include <cstdint>
#include <string_view>

#include "bounds/interval.hpp"

namespace skc::bounds {

enum class UnaryFunction : std::uint8_t {
#define SKC_BOUNDED_FUNCTION(Name, spelling) Name,
#include "bounds/functions.def"
#undef SKC_BOUNDED_FUNCTION
};

/// As in sk/error_bounds.def.
std::string_view spelling(UnaryFunction function);

/// True if the function has a value at each number of x.
bool isDefined(UnaryFunction function, Interval x);
/// The values at the numbers of x where the function is defined.
Interval valueOf(UnaryFunction function, Interval x);
/// The derivatives there; not finite where one is not.
Interval slopeOf(UnaryFunction function, Interval x);

enum class BinaryFunction : std::uint8_t { Pow, Atan2, Hypot };

bool isDefined(BinaryFunction function, Interval x, Interval y);
Interval valueOf(BinaryFunction function, Interval x, Interval y);
struct Slopes {
  Interval x, y;
};
Slopes slopesOf(BinaryFunction function, Interval x, Interval y);

}  // namespace skc::bounds
