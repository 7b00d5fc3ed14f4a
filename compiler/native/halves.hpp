// SPDX-License-Identifier: MIT
//
// Conversions between float and half (IEEE 754 binary16), rounding to nearest, ties to even. CPUs that convert in hardware do;
// on others the conversions are functions that are called, because a kernel that computes in half precision rounds after
// every operation.
#pragma once

#include "native/lanes.hpp"

namespace skc::native {

/// The float that a half of these bits is.
Part floatOfHalf(Lanes& lanes, const Part& bits);
/// The bits of the half that is nearest to a float.
Part halfOfFloat(Lanes& lanes, const Part& value);
/// Rounds a float to half precision; the result is a float.
Part roundedToHalf(Lanes& lanes, const Part& value);

}  // namespace skc::native
