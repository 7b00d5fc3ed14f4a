// SPDX-License-Identifier: MIT
//
// int and uint of the language in native code: 32 bits, and defined for every operand. Arithmetic wraps; a
// quotient by 0 is the dividend and the remainder 0 (as WGSL has it); a shift counts modulo 32; what is made
// of a real number is the nearest integer towards 0 that the type holds, and of NaN 0.
#pragma once

#include <compare>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace sk::native {

template <class Word>
class Integer {
 public:
  using Bits = std::uint32_t;

  Integer() = default;
  template <class T>
    requires(std::integral<T> || std::is_enum_v<T>)
  constexpr Integer(T value) : word_(static_cast<Word>(value)) {}
  template <class Other>
  explicit constexpr Integer(Integer<Other> other) : word_(static_cast<Word>(other.word())) {}

  constexpr Word word() const { return word_; }
  explicit constexpr operator bool() const { return word_ != 0; }

  friend constexpr Integer operator+(Integer a, Integer b) { return of(a.bits() + b.bits()); }
  friend constexpr Integer operator-(Integer a, Integer b) { return of(a.bits() - b.bits()); }
  friend constexpr Integer operator*(Integer a, Integer b) { return of(a.bits() * b.bits()); }
  friend constexpr Integer operator/(Integer a, Integer b) {
    if (b.word_ == 0) return a;
    return isOne(b, -1) ? -a : Integer(static_cast<Word>(a.word_ / b.word_));
  }
  friend constexpr Integer operator%(Integer a, Integer b) {
    return b.word_ == 0 || isOne(b, -1) ? Integer(0) : Integer(static_cast<Word>(a.word_ % b.word_));
  }
  friend constexpr Integer operator&(Integer a, Integer b) { return of(a.bits() & b.bits()); }
  friend constexpr Integer operator|(Integer a, Integer b) { return of(a.bits() | b.bits()); }
  friend constexpr Integer operator^(Integer a, Integer b) { return of(a.bits() ^ b.bits()); }
  template <class Other>
  friend constexpr Integer operator<<(Integer a, Integer<Other> count) {
    return of(a.bits() << (static_cast<Bits>(count.word()) & 31U));
  }
  template <class Other>
  friend constexpr Integer operator>>(Integer a, Integer<Other> count) {
    return Integer(static_cast<Word>(a.word_ >> (static_cast<Bits>(count.word()) & 31U)));
  }
  friend constexpr Integer operator-(Integer a) { return of(0U - a.bits()); }
  friend constexpr Integer operator~(Integer a) { return of(~a.bits()); }
  friend constexpr bool operator==(Integer a, Integer b) = default;
  friend constexpr auto operator<=>(Integer a, Integer b) = default;

 private:
  constexpr Bits bits() const { return static_cast<Bits>(word_); }
  static constexpr Integer of(Bits bits) { return Integer(static_cast<Word>(bits)); }
  /// Of int only: a quotient by -1 may be too large for it.
  static constexpr bool isOne(Integer a, int one) {
    return std::is_signed_v<Word> && a.word_ == static_cast<Word>(one);
  }

  Word word_;
};

using Int = Integer<std::int32_t>;
using Uint = Integer<std::uint32_t>;

namespace literals {
constexpr Int operator""_i(unsigned long long value) { return Int(value); }
constexpr Uint operator""_u(unsigned long long value) { return Uint(value); }
}  // namespace literals

template <class T>
inline constexpr bool isInteger = false;
template <class Word>
inline constexpr bool isInteger<Integer<Word>> = true;

/// The integer that a real number becomes.
template <class Word, class Real>
constexpr Integer<Word> truncated(Real x) {
  using Limits = std::numeric_limits<Word>;
  constexpr Real least = static_cast<Real>(Limits::min());
  constexpr Real beyond = static_cast<Real>(Limits::max() / 2 + 1) * 2;   // a power of 2, and so exact
  if (!(x > least)) return x <= least ? Limits::min() : Word{0};
  return x >= beyond ? Limits::max() : static_cast<Word>(x);
}

/// A whole number as an index. The upper end is the largest int that a float holds, on every device.
template <class Real>
constexpr Int wholeIndex(Real x) {
  return x > Real(2147483520) ? Int(2147483520) : truncated<std::int32_t>(x);
}

}  // namespace sk::native
