// SPDX-License-Identifier: MIT
//
// Vectors, matrices and arrays of the language in native code. Operators work by component; one operand
// may be a scalar. An index outside takes the nearest component or element.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "sk/native/integer.hpp"

namespace sk::native {

/// The index of one of `count` elements.
template <class Index>
constexpr std::size_t inside(Index index, std::size_t count) {
  if constexpr (isInteger<Index>) {
    return inside(index.word(), count);
  } else if constexpr (std::is_signed_v<Index>) {
    return index < 0 ? 0 : std::min(static_cast<std::size_t>(index), count - 1);
  } else {
    return std::min(static_cast<std::size_t>(index), count - 1);
  }
}

template <class T, std::size_t N>
struct Vec;

template <class T>
inline constexpr std::size_t widthOf = 1;
template <class T, std::size_t N>
inline constexpr std::size_t widthOf<Vec<T, N>> = N;
template <class T>
concept Vector = widthOf<T> > 1;

template <class T>
struct ComponentOf {
  using Type = T;
};
template <class T, std::size_t N>
struct ComponentOf<Vec<T, N>> {
  using Type = T;
};
template <class T>
using Component = typename ComponentOf<T>::Type;

template <class T>
constexpr T& componentAt(T& value, std::size_t) {
  return value;
}
template <class T, std::size_t N>
constexpr T& componentAt(Vec<T, N>& value, std::size_t i) {
  return value.components[i];
}
template <class T, std::size_t N>
constexpr const T& componentAt(const Vec<T, N>& value, std::size_t i) {
  return value.components[i];
}

template <class T, std::size_t N>
struct Vec {
  T components[N];

  Vec() = default;
  explicit constexpr Vec(const T& all) { std::fill_n(components, N, all); }
  /// Scalars and vectors whose components are N together.
  template <class... Parts>
    requires(sizeof...(Parts) > 1 && (widthOf<Parts> + ...) == N)
  explicit constexpr Vec(const Parts&... parts) {
    std::size_t next = 0;
    (put(next, parts), ...);
  }

  template <class Index>
  constexpr T& operator[](Index i) {
    return components[inside(i, N)];
  }
  template <class Index>
  constexpr const T& operator[](Index i) const {
    return components[inside(i, N)];
  }

 private:
  template <class Part>
  constexpr void put(std::size_t& next, const Part& part) {
    for (std::size_t i = 0; i < widthOf<Part>; ++i) components[next++] = T(componentAt(part, i));
  }
};

/// The vector, or scalar, of `operation` of the components of all arguments; scalars serve for every one.
template <class Operation, class... Arguments>
constexpr auto byComponent(Operation&& operation, const Arguments&... arguments) {
  constexpr std::size_t width = std::max({widthOf<Arguments>...});
  if constexpr (width == 1) {
    return operation(arguments...);
  } else {
    using Result = decltype(operation(componentAt(arguments, 0)...));
    // no loop: the compiler then keeps the components in registers
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      const auto at = [&](std::size_t i) { return operation(componentAt(arguments, i)...); };
      return Vec<Result, width>(at(I)...);
    }(std::make_index_sequence<width>());
  }
}

template <class A, class B>
concept OneVector = Vector<A> || Vector<B>;

// clang-format off: one operator a line
template <class A, class B> requires OneVector<A, B> constexpr auto operator+(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x + y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator-(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x - y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator*(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x * y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator/(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x / y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator%(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x % y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator&(const A& a, const B& b) { return byComponent([](auto x, auto y) { return decltype(x)(x & y); }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator|(const A& a, const B& b) { return byComponent([](auto x, auto y) { return decltype(x)(x | y); }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator^(const A& a, const B& b) { return byComponent([](auto x, auto y) { return decltype(x)(x ^ y); }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator<<(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x << y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator>>(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x >> y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator<(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x < y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator<=(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x <= y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator>(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x > y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator>=(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x >= y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator==(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x == y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator!=(const A& a, const B& b) { return byComponent([](auto x, auto y) { return x != y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator&&(const A& a, const B& b) { return byComponent([](bool x, bool y) { return x && y; }, a, b); }
template <class A, class B> requires OneVector<A, B> constexpr auto operator||(const A& a, const B& b) { return byComponent([](bool x, bool y) { return x || y; }, a, b); }
template <Vector A> constexpr auto operator-(const A& a) { return byComponent([](auto x) { return -x; }, a); }
template <Vector A> constexpr auto operator~(const A& a) { return byComponent([](auto x) { return ~x; }, a); }
template <Vector A> constexpr auto operator!(const A& a) { return byComponent([](bool x) { return !x; }, a); }
// clang-format on

/// Components of a vector: one as a scalar, several as a vector.
template <std::size_t... I, class T, std::size_t N>
constexpr auto swizzle(const Vec<T, N>& v) {
  if constexpr (sizeof...(I) == 1) {
    return (v.components[I], ...);
  } else {
    return Vec<T, sizeof...(I)>(v.components[I]...);
  }
}

/// Writes them; no component is named twice. The value may be of the same vector.
template <std::size_t... I, class T, std::size_t N>
constexpr void assign(Vec<T, N>& v, Vec<T, sizeof...(I)> value) {
  std::size_t next = 0;
  ((v.components[I] = value.components[next++]), ...);
}

/// One of these components, at a computed index.
template <std::size_t... I, class T, std::size_t N, class Index>
constexpr T& component(Vec<T, N>& v, Index index) {
  constexpr std::size_t places[] = {I...};
  return v.components[places[inside(index, sizeof...(I))]];
}
template <std::size_t... I, class T, std::size_t N, class Index>
constexpr T component(const Vec<T, N>& v, Index index) {
  return componentAt(swizzle<I...>(v), inside(index, sizeof...(I)));
}

/// condition ? yes : no, of vectors by component.
template <std::size_t N, class T>
constexpr Vec<T, N> select(const Vec<bool, N>& condition, const Vec<T, N>& yes, const Vec<T, N>& no) {
  return byComponent([](bool c, const T& y, const T& n) { return c ? y : n; }, condition, yes, no);
}

/// Square: `m[i]` is row i.
template <class T, std::size_t N>
struct Mat {
  Vec<T, N> rows[N];

  Mat() = default;
  template <class... Rows>
    requires(sizeof...(Rows) == N)
  explicit constexpr Mat(const Rows&... all) : rows{all...} {}

  template <class Index>
  constexpr Vec<T, N>& operator[](Index i) {
    return rows[inside(i, N)];
  }
  template <class Index>
  constexpr const Vec<T, N>& operator[](Index i) const {
    return rows[inside(i, N)];
  }

  template <class Operation>
  static constexpr Mat byRow(Operation&& operation) {
    Mat result;
    for (std::size_t i = 0; i < N; ++i) result.rows[i] = operation(i);
    return result;
  }

  friend constexpr Mat operator+(const Mat& a, const Mat& b) {
    return byRow([&](std::size_t i) { return a.rows[i] + b.rows[i]; });
  }
  friend constexpr Mat operator-(const Mat& a, const Mat& b) {
    return byRow([&](std::size_t i) { return a.rows[i] - b.rows[i]; });
  }
  friend constexpr Mat operator-(const Mat& a) {
    return byRow([&](std::size_t i) { return -a.rows[i]; });
  }
  friend constexpr Mat operator*(const Mat& a, const T& s) {
    return byRow([&](std::size_t i) { return a.rows[i] * s; });
  }
  friend constexpr Mat operator*(const T& s, const Mat& a) {
    return byRow([&](std::size_t i) { return s * a.rows[i]; });
  }
  friend constexpr Mat operator/(const Mat& a, const T& s) {
    return byRow([&](std::size_t i) { return a.rows[i] / s; });
  }
  friend constexpr Vec<T, N> operator*(const Mat& a, const Vec<T, N>& column) {
    Vec<T, N> result;
    for (std::size_t i = 0; i < N; ++i) {
      T sum = a.rows[i].components[0] * column.components[0];
      for (std::size_t k = 1; k < N; ++k) sum = sum + a.rows[i].components[k] * column.components[k];
      result.components[i] = sum;
    }
    return result;
  }
  friend constexpr Mat operator*(const Mat& a, const Mat& b) {
    return byRow([&](std::size_t i) {
      Vec<T, N> row = b.rows[0] * a.rows[i].components[0];
      for (std::size_t k = 1; k < N; ++k) row = row + b.rows[k] * a.rows[i].components[k];
      return row;
    });
  }
  friend constexpr bool operator==(const Mat& a, const Mat& b) {
    bool same = true;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) same = same && a.rows[i].components[k] == b.rows[i].components[k];
    }
    return same;
  }
};

template <class T, std::size_t N>
struct Array {
  T elements[N];

  Array() = default;
  template <class... Elements>
    requires(sizeof...(Elements) == N)
  explicit constexpr Array(const Elements&... all) : elements{all...} {}

  template <class Index>
  constexpr T& operator[](Index i) {
    return elements[inside(i, N)];
  }
  template <class Index>
  constexpr const T& operator[](Index i) const {
    return elements[inside(i, N)];
  }
};

}  // namespace sk::native
