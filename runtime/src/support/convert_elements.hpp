// SPDX-License-Identifier: MIT
//
// Elements in host memory with their floats in another precision: halves, floats or doubles.
#pragma once

#include <cstddef>

#include "sk/program.hpp"

namespace sk {

/// Elements of as many components, in the same order; each is rounded to nearest, of two the even one.
void convertElements(const program::Element& from, const std::byte* source, const program::Element& to,
                     std::byte* target, std::size_t count);

/// Every component of elements of nothing but halves, floats and doubles, as doubles, one element after the other; and back.
void readComponents(const program::Element& element, const std::byte* elements, std::size_t count,
                    double* values);
void writeComponents(const program::Element& element, std::byte* elements, std::size_t count,
                     const double* values);

}  // namespace sk
