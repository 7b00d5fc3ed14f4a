// SPDX-License-Identifier: MIT
//
// Converts elements in host memory between halves, floats and doubles.
#pragma once

#include <cstddef>
#include <vector>

#include "sk/program.hpp"

namespace sk {

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
