// SPDX-License-Identifier: MIT
//
// Iterators on the host's side: whether one fits a domain, and its step.
#pragma once

#include <array>
#include <cstdint>

#include "assemble/region_layout.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

/// Bits of the components of an iterator's step.
using IteratorStep = std::array<std::uint32_t, 4>;

/// Throws sk::Error, naming kernel and parameter, unless an iterator with these ends (two elements, one
/// after the other) goes over a domain of this shape, which is not empty.
void checkIterator(const program::Kernel& kernel, const program::Parameter& parameter, const void* ends,
                   const Shape& domain);

/// The step of an iterator that fits.
IteratorStep stepOf(const program::Parameter& parameter, const void* ends, const Shape& domain);

/// Whether its components count the elements instead of each following a dimension of its own.
bool countsElements(const program::Parameter& parameter, int rank);

}  // namespace sk
