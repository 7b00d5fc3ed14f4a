// SPDX-License-Identifier: MIT
#include "native/scalars.hpp"

#include <algorithm>
#include <cstring>

#include "native/convert_floats.hpp"

namespace sk {

namespace {

/// Calls visit<Held, Read>() with types of these sizes.
template <class Visit>
void withTypes(ScalarBytes bytes, Visit&& visit) {
  if (bytes.held != bytes.read) return visit.template operator()<float, double>();
  withScalar(bytes.read, [&]<class T> { visit.template operator()<T, T>(); });
}

template <class Held, class Read>
Read readAt(const std::byte* array, std::int64_t index) {
  Held value;
  std::memcpy(&value, array + index * static_cast<std::int64_t>(sizeof value), sizeof value);
  return static_cast<Read>(value);
}

template <class Read>
void writeAt(std::byte* array, std::int64_t index, const Read& value) {
  std::memcpy(array + index * static_cast<std::int64_t>(sizeof value), &value, sizeof value);
}

}  // namespace

std::size_t scalarsOf(const program::Element& element) {
  std::size_t scalars = 0;
  for (const program::Field& field : element.fields) scalars += field.width;
  return scalars;
}

void copyScalars(const Steps& from, ScalarBytes bytes, std::byte* to, std::int64_t count) {
  if (from.stride == 1 && bytes.held == bytes.read) {
    if (count > 0)
      std::memcpy(to, from.array + from.index * bytes.held, static_cast<std::size_t>(count) * bytes.held);
    return;
  }
  if (from.stride == 1 && bytes.held == sizeof(float) && bytes.read == sizeof(double)) {
    const auto* const floats = reinterpret_cast<const float*>(from.array) + from.index;
    return widenFloats(floats, count, reinterpret_cast<double*>(to));
  }
  withTypes(bytes, [&]<class Held, class Read> {
    if (from.stride == 1) {
      for (std::int64_t i = 0; i < count; ++i) writeAt(to, i, readAt<Held, Read>(from.array, from.index + i));
    } else if (from.stride == 0) {
      const Read value = readAt<Held, Read>(from.array, from.index);
      for (std::int64_t i = 0; i < count; ++i) writeAt(to, i, value);
    } else {
      // what is written may overlap `from`, as far as compilers know
      const std::byte* const first = from.array + from.index * static_cast<std::int64_t>(sizeof(Held));
      const std::int64_t stride = from.stride;
      if (stride == 2) {  // a constant becomes vectors
        for (std::int64_t i = 0; i < count; ++i) writeAt(to, i, readAt<Held, Read>(first, 2 * i));
        return;
      }
      for (std::int64_t i = 0; i < count; ++i) writeAt(to, i, readAt<Held, Read>(first, stride * i));
    }
  });
}

void stretchScalars(const Steps& from, ScalarBytes bytes, std::int64_t repeats, std::int64_t begun,
                    std::byte* to, std::int64_t count) {
  withTypes(bytes, [&]<class Held, class Read> {
    std::int64_t index = from.index;
    std::int64_t end = repeats - begun;
    for (std::int64_t i = 0; i < count; end += repeats, index += from.stride) {
      const Read value = readAt<Held, Read>(from.array, index);
      for (const std::int64_t last = std::min(end, count); i < last; ++i) writeAt(to, i, value);
    }
  });
}

void padScalars(std::byte* array, std::size_t bytes, std::int64_t count, std::int64_t room) {
  if (count >= room) return;
  static constexpr std::byte zero[mostScalarBytes] = {};
  const std::byte* last = count == 0 ? zero : array + static_cast<std::size_t>(count - 1) * bytes;
  fillScalars(last, bytes, array + static_cast<std::size_t>(count) * bytes, room - count);
}

void fillScalars(const void* value, std::size_t bytes, std::byte* to, std::int64_t count) {
  const auto size = static_cast<std::uint8_t>(bytes);
  copyScalars({static_cast<const std::byte*>(value), 0, 0}, {size, size}, to, count);
}

}  // namespace sk
