// SPDX-License-Identifier: MIT
//
// Converts elements in host memory between halves, floats and doubles, and makes one rounding of two.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sk/program.hpp"

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

/// Converts elements with the same number of components in the same order, rounding to nearest, ties to even.
void convertElements(const program::Element& from, const std::byte* source, const program::Element& to,
                     std::byte* target, std::size_t count);

/// Calls read(elements) with room for `count` elements of type `held`, and converts what it reads to elements
/// of type `declared`. Reads without a copy if the types are the same object.
template <class Read>
void readConverted(const program::Element& held, const program::Element& declared, std::size_t count,
                   std::byte* elements, Read&& read) {
  if (&held == &declared) {
    read(elements);
    return;
  }
  std::vector<std::byte> converted(count * held.size);
  read(converted.data());
  convertElements(held, converted.data(), declared, elements, count);
}

/// Calls write(elements) with `count` elements of type `held`, converted from elements of type `declared`.
template <class Write>
void writeConverted(const program::Element& held, const program::Element& declared, std::size_t count,
                    const std::byte* elements, Write&& write) {
  if (&held == &declared) {
    write(elements);
    return;
  }
  std::vector<std::byte> converted(count * held.size);
  convertElements(declared, elements, held, converted.data(), count);
  write(converted.data());
}

/// Reads all components, which are halves, floats or doubles, as doubles, element by element; and writes
/// them.
void readComponents(const program::Element& element, const std::byte* elements, std::size_t count,
                    double* values);
void writeComponents(const program::Element& element, std::byte* elements, std::size_t count,
                     const double* values);

}  // namespace sk
