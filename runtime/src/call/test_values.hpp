// SPDX-License-Identifier: MIT
//
// Values to put in the place of elements that nothing has written (call/check_unwritten_reads.hpp), and how results are
// compared. All values are finite, and some are 0, so that a weight of 0 hides them, and moderate, so that a kernel which takes
// one for a trip count comes to an end.
#pragma once

#include <cstddef>
#include <span>

#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {

/// How many values there are. Number 0 is zero; those from `firstLargeValue` on are large.
inline constexpr int testValueCount = 5, firstLargeValue = 3;

/// Sets all members of an element, which is laid out as the Element says, to test value `number`. `storage` is its stream's.
void setTestValue(const program::Element& element, Storage storage, int number, std::byte* bytes);

/// Sets all members to the value that the operation of a scatter output replaces by every other value.
void setNeutral(const program::Element& element, program::ScatterOp op, std::byte* bytes);

/// Whether two elements have the same values. Zeros of both signs are equal, and so are all NaNs.
bool haveSameValues(const program::Element& element, const std::byte* a, const std::byte* b);

/// Whether an element has a NaN.
bool hasNaN(const program::Element& element, const std::byte* bytes);

}  // namespace sk
