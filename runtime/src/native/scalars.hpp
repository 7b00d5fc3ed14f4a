// SPDX-License-Identifier: MIT
//
// Copies scalars of which only the size is known: brings elements into the scratch memory of object code.
#pragma once

#include <cstddef>
#include <cstdint>

#include "native/components.hpp"
#include "sk/program.hpp"

namespace sk {

inline constexpr std::size_t mostScalarBytes = 16;

/// The number of scalar components of an element.
std::size_t scalarsOf(const program::Element& element);

/// Calls visit(number, bytes in an array, type) for each scalar of an element, in order.
template <class Visit>
void forEachScalar(const program::Element& element, RealType real, Visit&& visit) {
  std::size_t number = 0;
  for (const program::Field& field : element.fields) {
    for (std::size_t c = 0; c < field.width; ++c)
      visit(number++, storedBytes(field.scalar, real), field.scalar);
  }
}

/// The size of a scalar in an array, and in the code that reads it. They differ if a float is read as a
/// double.
struct ScalarBytes {
  std::uint8_t held;
  std::uint8_t read;
};

struct Bytes16 {
  std::uint64_t words[2];
};

/// Calls visit<T>() with a type of this size.
template <class Visit>
void withScalar(std::size_t bytes, Visit&& visit) {
  switch (bytes) {
    case 1: return visit.template operator()<std::uint8_t>();
    case 2: return visit.template operator()<std::uint16_t>();
    case 4: return visit.template operator()<std::uint32_t>();
    case 8: return visit.template operator()<std::uint64_t>();
    default: return visit.template operator()<Bytes16>();
  }
}

/// What to read: element `index` of an array, then every `stride`-th element.
struct Steps {
  const std::byte* array;
  std::int64_t index;
  std::int64_t stride;
};

/// Copies `count` scalars to an array without gaps.
void copyScalars(const Steps& from, ScalarBytes bytes, std::byte* to, std::int64_t count);

/// Likewise, but repeats each scalar `repeats` times, and leaves out the first `begun` copies of the first
/// one.
void stretchScalars(const Steps& from, ScalarBytes bytes, std::int64_t repeats, std::int64_t begun,
                    std::byte* to, std::int64_t count);

/// Fills an array from `count` up to `room` with the last of its `count` scalars; with zeros if it has none.
void padScalars(std::byte* array, std::size_t bytes, std::int64_t count, std::int64_t room);

/// Writes `count` copies of a value.
void fillScalars(const void* value, std::size_t bytes, std::byte* to, std::int64_t count);

}  // namespace sk
