// SPDX-License-Identifier: MIT
//
// The first of two roundings that together round once.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace sk {

/// Rounds to a float that rounds to the half that is nearest to `value`: the nearest float if that is exact or odd, else its
/// odd neighbour on the other side of `value` (Boldo and Melquiond, IEEE Transactions on Computers 57, 2008).
inline float roundedToOdd(double value) {
  const auto nearest = static_cast<float>(value);
  const auto bits = std::bit_cast<std::uint32_t>(nearest);
  if (std::isnan(value) || static_cast<double>(nearest) == value || (bits & 1u) != 0) return nearest;
  const bool isBeyond = std::fabs(static_cast<double>(nearest)) > std::fabs(value);
  return std::bit_cast<float>(isBeyond ? bits - 1 : bits + 1);
}

}  // namespace sk
