// SPDX-License-Identifier: MIT
//
// Between elements in host memory and the texels of one of their planes. Bits are never changed, but
// for bools, which are 0 or 1 on both sides, and the channels that three components leave over, which
// are 0. Plain host code.
#pragma once

#include <cstddef>

#include "gl/format.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether the elements are the texels of their only plane, byte for byte.
bool areTexels(const program::Element& element);

/// The texels (format().tight) of a plane of `count` elements.
void packTexels(const program::Element& element, const program::Field& field, const std::byte* elements,
                std::size_t count, std::byte* texels);

/// The other way: writes the bytes of the field in each element, and no others.
void unpackTexels(const program::Element& element, const program::Field& field, const std::byte* texels,
                  std::size_t count, std::byte* elements);

/// Texels as ES reads them (format.wide) to format.tight.
void narrowTexels(const gl::Format& format, const std::byte* wide, std::size_t count, std::byte* tight);

}  // namespace sk
