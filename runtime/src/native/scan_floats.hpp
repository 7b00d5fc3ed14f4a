// SPDX-License-Identifier: MIT
//
// Scans of floats, or of products of two, in doubles: eight elements at a time, so that one addition in eight waits for
// the one before it. The additions are the same on every CPU.
#pragma once

#include <cstddef>

#include "sk/native/code.hpp"

namespace sk {

/// The frame of the runtime's own sums and scans.
struct SumFrame : native::Frame {
  double start;  ///< the identity; -0, which changes no term, if seeded
  double identity;
};

/// The function that scans terms of one or two factors, which are the slots, in a SumFrame. `storesFloats`: the arrays of
/// results hold floats, else doubles. The CPU must have 256-bit vectors if `isWide` (levelOfCpu).
native::ScanFunction* floatScan(std::size_t factors, bool storesFloats, bool isWide);

/// Writes the identity of a SumFrame.
void storeIdentity(const native::Frame* frame, void* const* values);

}  // namespace sk
