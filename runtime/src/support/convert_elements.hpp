// SPDX-License-Identifier: MIT
//
// Converts elements in host memory between halves, floats and doubles.
#pragma once

#include <cstddef>

#include "sk/program.hpp"

namespace sk {

/// Converts elements with the same number of components in the same order, rounding to nearest, ties to even.
void convertElements(const program::Element& from, const std::byte* source, const program::Element& to,
                     std::byte* target, std::size_t count);

/// Reads all components, which are halves, floats or doubles, as doubles, element by element; and writes
/// them.
void readComponents(const program::Element& element, const std::byte* elements, std::size_t count,
                    double* values);
void writeComponents(const program::Element& element, std::byte* elements, std::size_t count,
                     const double* values);

}  // namespace sk
