// SPDX-License-Identifier: MIT
//
// Values of lanes (lanes.hpp) from arrays of components and back: from neighbours, or from anywhere.
#pragma once

#include <cstdint>

#include "sk/native/element.hpp"
#include "sk/native/lanes.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // as in lanes.hpp

namespace sk::native {

/// Whether arrays of T can be read and written by lanes.
template <class T>
inline constexpr bool hasLanes = std::is_same_v<T, float> || std::is_same_v<T, bool> || isInteger<T>;
template <class T, std::size_t N>
inline constexpr bool hasLanes<Vec<T, N>> = hasLanes<T>;

/// A part as it lies among an array's elements: at any of their addresses. GCC 12 keeps a value in registers only if it never
/// goes through memcpy.
template <class T>
struct InMemoryOf;
template <>
struct InMemoryOf<float> {
  using Type [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = float;
};
template <>
struct InMemoryOf<Int> {
  using Type [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = std::int32_t;
};
template <>
struct InMemoryOf<Uint> {
  using Type [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = std::uint32_t;
};
template <class T>
using InMemory = typename InMemoryOf<T>::Type;

/// The number of each lane, from 0 on.
inline Lanes<Int> laneNumbers() {
  Lanes<Int> numbers;
  constexpr Truth first = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int p = 0; p < partCount; ++p) numbers.parts[p] = first + filled(p * lanesOfPart);
  return numbers;
}

/// The indices of an element and those that follow it along x.
inline Vec<Lanes<Int>, 4> lanesIndex(const Vec<Int, 4>& first) {
  return Vec<Lanes<Int>, 4>(first.components[0] + laneNumbers(), first.components[1], first.components[2],
                            first.components[3]);
}

/// A component's values in the neighbours from `array` on.
template <class T>
Lanes<T> loadLanes(const typename StoredOf<T>::Type* array) {
  if constexpr (std::is_same_v<T, bool>) {
    return laneByLane([&](Int lane) { return array[lane.word()] != 0; }, laneNumbers());
  } else {
    Lanes<T> result;
    for (int p = 0; p < partCount; ++p) result.parts[p] = reinterpret_cast<const InMemory<T>*>(array)[p];
    return result;
  }
}
template <class T>
void storeLanes(typename StoredOf<T>::Type* array, const Lanes<T>& value) {
  if constexpr (std::is_same_v<T, bool>) {
    for (int lane = 0; lane < laneCount; ++lane) array[lane] = static_cast<std::uint8_t>(value(lane));
  } else {
    for (int p = 0; p < partCount; ++p) reinterpret_cast<InMemory<T>*>(array)[p] = value.parts[p];
  }
}

/// component(array) for the array of each component, as a value of lanes.
template <class T, class Load>
LanesOf<T> eachComponent(void* const* arrays, Load&& component) {
  using Scalar = Component<T>;
  using Stored = typename StoredOf<Scalar>::Type;
  if constexpr (Vector<T>) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return LanesOf<T>(component(static_cast<const Stored*>(arrays[I]))...);
    }(std::make_index_sequence<widthOf<T>>());
  } else {
    return component(static_cast<const Stored*>(arrays[0]));
  }
}

/// The elements from one on.
template <class T>
LanesOf<T> loadNeighbours(void* const* arrays, std::int64_t element) {
  return eachComponent<T>(arrays,
                          [&](const auto* array) { return loadLanes<Component<T>>(array + element); });
}
template <class T>
void storeNeighbours(void* const* arrays, std::int64_t element, const LanesOf<T>& value) {
  using Scalar = Component<T>;
  for (std::size_t i = 0; i < widthOf<T>; ++i) {
    storeLanes<Scalar>(static_cast<typename StoredOf<Scalar>::Type*>(arrays[i]) + element,
                       componentAt(value, i));
  }
}

/// The elements of these numbers from `first` on, which are neighbours more often than not.
template <class T>
LanesOf<T> loadAnywhere(void* const* arrays, std::int64_t first, const Lanes<Int>& numbers) {
  const Int begin = numbers(0);
  if (all(numbers == begin + laneNumbers())) return loadNeighbours<T>(arrays, first + begin.word());
  if (all(numbers == begin)) return spread(load<T>(arrays, first + begin.word()));
  return eachComponent<T>(arrays, [&](const auto* array) {
    const auto* const from = array + first;
    return eachLane([&](Int number) { return static_cast<Component<T>>(from[number.word()]); }, numbers);
  });
}

}  // namespace sk::native

#pragma GCC diagnostic pop
