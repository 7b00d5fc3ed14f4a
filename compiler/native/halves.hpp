// SPDX-License-Identifier: MIT
//
// Conversions between float and half (IEEE 754 binary16), rounding to nearest, ties to even. CPUs without
// instructions for them call functions, because a kernel that computes in half precision rounds after every
// operation.
#pragma once

#include "native/lanes.hpp"

namespace skc::native {

/// The float with the value of the half that has these bits.
Part floatOfHalf(Lanes& lanes, const Part& bits);
/// The bits of the half nearest to a float.
Part halfOfFloat(Lanes& lanes, const Part& value);
/// CountedLoop a float to half precision; the result is a float.
Part roundedToHalf(Lanes& lanes, const Part& value);

}  // namespace skc::native
