// SPDX-License-Identifier: MIT
//
// Exact sums of floats in native code, as compiler/ir/intrinsics.def has them: an integer of digits of 26 bits, in groups
// of four, lowest first, which counts units of 2^-149, or, of products, of 2^-298.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "sk/native/scalar.hpp"
#include "sk/native/vector.hpp"

namespace sk::native {

namespace exact {

inline constexpr std::int32_t digitMask = 0x3ffffff;

/// A float as sign, mantissa and the bit at which that begins; of one that is not finite, the mantissa is 0.
struct Parts {
  [[gnu::always_inline]] explicit Parts(float x) : bits(std::bit_cast<std::uint32_t>(x)) {
    const std::uint32_t field = bits >> 23 & 255;
    isFinite = field != 255;
    mantissa = isFinite ? (bits & 0x7fffff) | std::min(field, 1U) << 23 : 0;
    at = static_cast<std::int32_t>(std::max(field, 1U)) - 1;
  }
  std::uint32_t bits;
  std::uint64_t mantissa;
  std::int32_t at;
  bool isFinite;
};

/// Four digits at a time, as GCC and Clang know them.
using Lanes [[gnu::vector_size(16)]] = std::int32_t;

/// The digits of a group that `mantissa` has, of up to 48 bits, where it begins at bit `at`. All groups of one number are
/// asked for in a row: inlined, they share the work.
[[gnu::always_inline]] inline Vec<Int, 4> digits(std::uint64_t mantissa, std::int32_t at, bool isNegative,
                                                 Int group) {
  const std::int32_t first = at / 26;
  const std::int32_t shift = at - 26 * first;
  const std::uint64_t rest = mantissa >> (26 - shift);
  const std::int32_t sign = isNegative ? -1 : 0;
  const auto signedDigit = [&](std::uint64_t bits) {
    return (static_cast<std::int32_t>(bits) ^ sign) - sign;
  };
  const Lanes place = Lanes{0, 1, 2, 3} + (4 * group.word() - first);
  const Lanes value = ((place == 0) & signedDigit(mantissa << shift & digitMask)) |
                      ((place == 1) & signedDigit(rest & digitMask)) |
                      ((place == 2) & signedDigit(rest >> 26));
  return std::bit_cast<Vec<Int, 4>>(value);
}

}  // namespace exact

template <class Real>
[[gnu::always_inline]] inline Vec<Int, 4> exactDigits(Real x, Int group) {
  const exact::Parts parts(static_cast<float>(x));
  return exact::digits(parts.mantissa, parts.at, parts.bits >> 31 != 0, group);
}

template <class Real>
[[gnu::always_inline]] inline Int exactFlags(Real x) {
  const std::uint32_t bits = exact::Parts(static_cast<float>(x)).bits;
  const std::uint32_t magnitude = bits & 0x7fffffff;
  if (magnitude < 0x7f800000) return bits == 0x80000000 ? 0 : 1;
  return magnitude > 0x7f800000 ? 8 : bits >> 31 != 0 ? 4 : 2;
}

template <class Real>
[[gnu::always_inline]] inline Vec<Int, 4> exactProductDigits(Real x, Real y, Int group) {
  const exact::Parts a(static_cast<float>(x));
  const exact::Parts b(static_cast<float>(y));
  return exact::digits(a.mantissa * b.mantissa, a.at + b.at, (a.bits ^ b.bits) >> 31 != 0, group);
}

template <class Real>
[[gnu::always_inline]] inline Int exactProductFlags(Real x, Real y) {
  const exact::Parts a(static_cast<float>(x));
  const exact::Parts b(static_cast<float>(y));
  const std::uint32_t low = std::min(a.bits & 0x7fffffff, b.bits & 0x7fffffff);
  const std::uint32_t high = std::max(a.bits & 0x7fffffff, b.bits & 0x7fffffff);
  const bool isNegative = (a.bits ^ b.bits) >> 31 != 0;
  if (high < 0x7f800000) return low == 0 && isNegative ? 0 : 1;
  return high > 0x7f800000 || low == 0 ? 8 : isNegative ? 4 : 2;
}

inline Int exactCarry(const Vec<Int, 4>& digits, Int carry) {
  std::int32_t c = carry.word();
  for (const Int digit : digits.components) c = (c + digit.word()) >> 26;
  return c;
}

inline Vec<Int, 4> exactSettled(const Vec<Int, 4>& digits, Int carry, bool isLast) {
  Vec<Int, 4> result;
  std::int32_t c = carry.word();
  for (std::size_t k = 0; k < 4; ++k) {
    const std::int32_t digit = digits.components[k].word() + c;
    c = digit >> 26;
    result.components[k] = isLast && k == 3 ? digit : digit & exact::digitMask;
  }
  return result;
}

/// The float nearest to the integer, ties to even, of settled digits that are not negative; `baseBit` is the integer's bit that
/// stands for 2^-149.
inline float exactRounded(const Vec<Int, 4>& a, const Vec<Int, 4>& b, const Vec<Int, 4>& c,
                          const Vec<Int, 4>& d, const Vec<Int, 4>& e, const Vec<Int, 4>& f, Int flagBits,
                          bool isNegative, Int baseBit) {
  const std::int32_t flags = flagBits.word();
  const std::int32_t base = baseBit.word();
  if ((flags & 8) != 0 || (flags & 6) == 6) return std::numeric_limits<float>::quiet_NaN();
  if ((flags & 6) != 0) return std::bit_cast<float>((flags & 2) != 0 ? 0x7f800000U : 0xff800000U);
  std::int32_t n[25] = {};  // a 0 below the first
  std::int32_t* next = n + 1;
  for (const Vec<Int, 4>* group : {&a, &b, &c, &d, &e, &f}) {
    for (const Int digit : group->components) *next++ = digit.word();
  }
  std::int32_t top = 24;
  while (top > 0 && n[top] == 0) --top;
  if (top == 0) return (flags & 1) == 0 ? -0.0F : 0.0F;
  const std::uint64_t last =
      static_cast<std::uint64_t>(n[top]) << 26 | static_cast<std::uint64_t>(n[top - 1]);
  const auto width = static_cast<std::int32_t>(std::bit_width(last));  // 27 to 52
  const std::int32_t first = 26 * (top - 2);  // the integer's bit that is the lowest of `last`
  const std::int32_t unit = std::max(first + width - 24, base);
  const std::int32_t shift = std::min(unit - first, 54);
  auto m = static_cast<std::uint32_t>(last >> shift);
  bool isMore = (last & ((std::uint64_t{1} << (shift - 1)) - 1)) != 0;
  for (std::int32_t k = 0; k < top - 1; ++k) isMore = isMore || n[k] != 0;
  const bool isHalf = (last >> (shift - 1) & 1) != 0;
  if (isHalf && (isMore || (m & 1) != 0)) ++m;
  const std::uint32_t bits = (static_cast<std::uint32_t>(std::min(unit - base, 254)) << 23) + m;
  return std::bit_cast<float>(std::min(bits, 0x7f800000U) | (isNegative ? 0x80000000U : 0U));
}

}  // namespace sk::native
