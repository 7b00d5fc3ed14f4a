// SPDX-License-Identifier: MIT
//
// Iterators on the host: whether one fits a domain, and its step.
#pragma once

#include <array>
#include <cstdint>

#include "assemble/region_layout.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

/// The bits of an iterator's step, by component.
using IteratorStep = std::array<std::uint32_t, 4>;

/// Throws sk::Error, which names the kernel and the parameter, unless an iterator with these ends (two
/// consecutive elements) fits a nonempty domain of this shape.
void checkIterator(const program::Kernel& kernel, const program::Parameter& parameter, const void* ends,
                   const Shape& domain);

/// The step of an iterator that has been checked.
IteratorStep stepOf(const program::Parameter& parameter, const void* ends, const Shape& domain);

/// Whether all components advance with the element number, instead of each along its own dimension.
bool countsElements(const program::Parameter& parameter, int rank);

}  // namespace sk
