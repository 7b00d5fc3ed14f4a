// SPDX-License-Identifier: MIT
//
// How values of native code lie in memory: an array for each scalar component, in the order of the
// declaration. Structs tell their members by sk_members(), a tuple of pointers to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include "sk/native/scalar.hpp"

namespace sk::native {

/// What an array of a component holds.
template <class T>
struct StoredOf {
  using Type = T;
};
template <>
struct StoredOf<bool> {
  using Type = std::uint8_t;
};

/// A cursor over the components of one element.
struct Cursor {
  void* const* component;
  std::int64_t element;

  template <class T>
  T& next() {
    return static_cast<T*>(*component++)[element];
  }
};

template <class T>
constexpr void visit(T& value, auto&& scalar);

/// scalar(component) for every scalar of a value, in order.
template <class T>
  requires requires { T::sk_members(); }
constexpr void visitMembers(T& value, auto&& scalar) {
  std::apply([&](auto... members) { (visit(value.*members, scalar), ...); }, T::sk_members());
}
/// each(item) for all, without a loop: the compiler then keeps them in registers.
template <class T, std::size_t N>
constexpr void unrolled(T (&items)[N], auto&& each) {
  [&]<std::size_t... I>(std::index_sequence<I...>) { (each(items[I]), ...); }(std::make_index_sequence<N>());
}

template <class T, std::size_t N>
constexpr void visitMembers(Vec<T, N>& value, auto&& scalar) {
  unrolled(value.components, scalar);
}
template <class T, std::size_t N>
constexpr void visitMembers(Mat<T, N>& value, auto&& scalar) {
  unrolled(value.rows, [&](Vec<T, N>& row) { visitMembers(row, scalar); });
}
/// The accumulators of a reduction.
template <class... T>
constexpr void visitMembers(std::tuple<T...>& value, auto&& scalar) {
  std::apply([&](T&... accumulator) { (visit(accumulator, scalar), ...); }, value);
}
template <class T, std::size_t N>
constexpr void visitMembers(Array<T, N>& value, auto&& scalar) {
  for (T& element : value.elements) visit(element, scalar);
}

template <class T>
constexpr void visit(T& value, auto&& scalar) {
  if constexpr (requires { visitMembers(value, scalar); }) {
    visitMembers(value, scalar);
  } else {
    scalar(value);
  }
}

/// How many scalars a value has, and their bytes in memory.
struct Footprint {
  std::size_t scalars = 0;
  std::size_t bytes = 0;
};
template <class T>
constexpr Footprint footprintOf() {
  Footprint footprint;
  T value{};
  visit(value, [&]<class S>(S&) {
    ++footprint.scalars;
    footprint.bytes += sizeof(typename StoredOf<S>::Type);
  });
  return footprint;
}

template <class T>
T load(void* const* components, std::int64_t element) {
  T value{};
  Cursor cursor{components, element};
  visit(value,
        [&]<class S>(S& scalar) { scalar = static_cast<S>(cursor.next<typename StoredOf<S>::Type>()); });
  return value;
}

/// What an array of a component holds; or one that holds floats where the component has another real type.
template <class S, bool isFloats>
using HeldAs = std::conditional_t<isFloats && std::is_floating_point_v<S>, float, typename StoredOf<S>::Type>;

/// Of arrays that hold floats where T has another real type.
template <class T>
T loadFloats(void* const* components, std::int64_t element) {
  T value{};
  Cursor cursor{components, element};
  visit(value, [&]<class S>(S& scalar) { scalar = static_cast<S>(cursor.next<HeldAs<S, true>>()); });
  return value;
}

template <class T>
void store(void* const* components, std::int64_t element, T value) {
  Cursor cursor{components, element};
  visit(value, [&]<class S>(S& scalar) {
    using Stored = typename StoredOf<S>::Type;
    cursor.next<Stored>() = static_cast<Stored>(scalar);
  });
}

/// Appends the value's components to their arrays.
template <class T, class Arrays>
void append(Arrays& arrays, T value) {
  std::size_t component = 0;
  visit(value, [&]<class S>(S& scalar) {
    const auto stored = static_cast<typename StoredOf<S>::Type>(scalar);
    const auto* bytes = reinterpret_cast<const std::byte*>(&stored);
    arrays[component].insert(arrays[component].end(), bytes, bytes + sizeof stored);
    ++component;
  });
}

}  // namespace sk::native
