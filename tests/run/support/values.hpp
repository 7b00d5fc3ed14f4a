// SPDX-License-Identifier: MIT
//
// Host arrays of test values, streams made from them, and comparisons: `difference` is "" if two arrays agree, else it
// names the first elements that differ.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "sk/sk.hpp"

namespace run_tests {

/// Hashes a number (the finaliser of MurmurHash3), so that test values are the same on every machine.
inline std::uint32_t hashed(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x85ebca6bu;
  x ^= x >> 13;
  x *= 0xc2b2ae35u;
  return x ^ (x >> 16);
}

/// A value of type T for element i: floats in [-8, 8) with 8 fraction bits, integers of all magnitudes.
template <class T>
T valueAt(std::uint32_t i) {
  const std::uint32_t bits = hashed(i * 2654435761u + 12345u);
  if constexpr (std::is_same_v<T, bool>) {
    return (bits >> 7) & 1u;
  } else if constexpr (std::is_same_v<T, float>) {
    return static_cast<float>(static_cast<int>(bits & 0xfffu) - 2048) / 256.0f;
  } else if constexpr (std::is_integral_v<T>) {
    return static_cast<T>(bits >> (i % 5 * 6));
  } else {
    using C = decltype(T::x);
    if constexpr (requires(T v) { v.w; }) {
      return {valueAt<C>(4 * i), valueAt<C>(4 * i + 1), valueAt<C>(4 * i + 2), valueAt<C>(4 * i + 3)};
    } else if constexpr (requires(T v) { v.z; }) {
      return {valueAt<C>(4 * i), valueAt<C>(4 * i + 1), valueAt<C>(4 * i + 2)};
    } else {
      return {valueAt<C>(4 * i), valueAt<C>(4 * i + 1)};
    }
  }
}

template <class T>
std::vector<sk::HostElement<T>> values(std::int64_t count, std::uint32_t seed = 0) {
  std::vector<sk::HostElement<T>> result(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = valueAt<T>(static_cast<std::uint32_t>(i) + seed * 7919u);
  }
  return result;
}

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const sk::Shape& shape,
                       const std::vector<sk::HostElement<T>>& elements) {
  sk::Stream<T> stream = device.stream<T>(shape);
  stream.write(elements);
  return stream;
}

/// A stream of rank 1 with these elements.
template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<sk::HostElement<T>>& elements) {
  return streamOf<T>(device, {static_cast<std::int64_t>(elements.size())}, elements);
}

template <class T>
void show(std::ostream& out, const T& value) {
  if constexpr (std::is_same_v<T, std::uint8_t> || std::is_same_v<T, bool>) {
    out << int{value};
  } else if constexpr (std::is_floating_point_v<T>) {
    out.precision(9);
    out << value;
  } else if constexpr (std::is_arithmetic_v<T>) {
    out << value;
  } else if constexpr (requires { value.w; }) {
    out << '(';
    for (const auto component : {value.x, value.y, value.z, value.w}) show(out << ' ', component);
    out << " )";
  } else if constexpr (requires { value.z; }) {
    out << '(';
    for (const auto component : {value.x, value.y, value.z}) show(out << ' ', component);
    out << " )";
  } else if constexpr (requires {
                         value.x;
                         value.y;
                       }) {
    out << '(';
    for (const auto component : {value.x, value.y}) show(out << ' ', component);
    out << " )";
  } else {
    out << "{...}";
  }
}

/// Whether two values are equal, or both NaN.
template <class T>
bool isSame(const T& a, const T& b) {
  if constexpr (std::is_floating_point_v<T>) {
    return a == b || (std::isnan(a) && std::isnan(b));
  } else {
    return a == b;
  }
}

/// Whether an element agrees with the expected one, by a rule of the test.
template <class T>
using Agree = std::function<bool(const T& actual, const T& expected)>;

/// "" if both have the same size and agree(actual[i], expected[i]) for all i; without a rule, elements agree if isSame.
/// The types of most tests are compiled in values.cpp, once.
template <class T>
std::string differenceOf(const std::vector<T>& actual, const std::vector<T>& expected,
                         const Agree<T>& agree) {
  std::ostringstream out;
  if (actual.size() != expected.size()) {
    out << actual.size() << " elements, not " << expected.size();
    return out.str();
  }
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (agree(actual[i], expected[i])) continue;
    if (wrong++ < 4) {
      out << (wrong == 1 ? "" : "; ") << '[' << i << "] is ";
      show<T>(out, actual[i]);
      show<T>(out << ", not ", expected[i]);
    }
  }
  if (wrong > 4) out << "; " << wrong << " of " << expected.size() << " differ";
  return out.str();
}
template <class T>
std::string differenceOf(const std::vector<T>& actual, const std::vector<T>& expected) {
  return differenceOf<T>(actual, expected, isSame<T>);
}

#define SK_COMPILED_ONCE(T)                                                               \
  extern template std::string differenceOf(const std::vector<T>&, const std::vector<T>&); \
  extern template std::string differenceOf(const std::vector<T>&, const std::vector<T>&, const Agree<T>&);
#include "support/compared_types.def"
#undef SK_COMPILED_ONCE

/// expected(i) for all i in [0, count).
template <class T, class Expected>
std::vector<T> listed(std::size_t count, const Expected& expected) {
  std::vector<T> list(count);
  for (std::size_t i = 0; i < count; ++i) list[i] = static_cast<T>(expected(i));
  return list;
}

/// "" if agree(actual[i], expected(i)) for all i in [0, count).
template <class T, std::invocable<std::size_t> Expected>
std::string difference(const std::vector<T>& actual, std::size_t count, const Expected& expected,
                       const std::type_identity_t<Agree<T>>& agree) {
  return differenceOf<T>(actual, listed<T>(count, expected), agree);
}

/// "" if every element is equal to the expected one, or both are NaN.
template <class T>
std::string difference(const std::vector<T>& actual, const std::vector<T>& expected) {
  return differenceOf<T>(actual, expected);
}
template <class T, std::invocable<std::size_t> Expected>
std::string difference(const std::vector<T>& actual, const Expected& expected) {
  return differenceOf<T>(actual, listed<T>(actual.size(), expected));
}

/// "" if every element is within `absolute` or `relative` of the expected one, whichever allows more.
std::string difference(const std::vector<float>& actual, const std::vector<float>& expected, double absolute,
                       double relative);
template <std::invocable<std::size_t> Expected>
std::string difference(const std::vector<float>& actual, const Expected& expected, double absolute,
                       double relative) {
  return difference(actual, listed<float>(actual.size(), expected), absolute, relative);
}

}  // namespace run_tests
