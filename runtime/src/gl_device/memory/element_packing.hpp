// SPDX-License-Identifier: MIT
//
// Converts between elements in host memory and the texels of one of their planes. Bits are copied unchanged,
// except that bools become 0 or 1, and that the fourth channel of three components becomes 0. Plain host
// code.
#pragma once

#include <cstddef>

#include "gl/format.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether the elements have one plane, whose texels equal them byte for byte.
bool areTexels(const program::Element& element);

/// Writes the texels (Format::tight) of one plane of `count` elements.
void packTexels(const program::Element& element, const program::Field& field, const std::byte* elements,
                std::size_t count, std::byte* texels);

/// The inverse of packTexels(). Writes only the bytes of the field in each element.
void unpackTexels(const program::Element& element, const program::Field& field, const std::byte* texels,
                  std::size_t count, std::byte* elements);

/// Converts `count` texels from Format::wide, which ES guarantees to read, to Format::tight.
void narrowTexels(const gl::Format& format, const std::byte* wide, std::size_t count, std::byte* tight);

}  // namespace sk
