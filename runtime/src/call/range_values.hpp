// SPDX-License-Identifier: MIT
//
// Compares the numbers of elements with the range that a parameter declares. The ends are rounded as the numbers are stored, so that
// 0.1 is in a range that ends at 0.1, whether it is a half, a float or a double. NaN is in no range.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {

/// The first number of an element that is not in a range.
struct OutOfRange {
  std::string component;  ///< ".x" in a vector, "[2]" in an array, else empty
  std::string value;
};

/// For an element that is laid out as the Element says. `storage` is that of its stream, or Single.
std::optional<OutOfRange> outOfRange(const program::Element& element, Storage storage,
                                     const program::ValueRange& range, const std::byte* bytes);

/// For the floats of an element that its stream stores as doubles, Extended or Double.
std::optional<OutOfRange> outOfRange(const program::Element& element, Storage storage,
                                     const program::ValueRange& range, const double* reals);

}  // namespace sk
