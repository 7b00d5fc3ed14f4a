// SPDX-License-Identifier: MIT
//
// Host versions of the language's storage-only types: half, and integers that represent numbers from 0 or -1
// to 1. They convert to and from float exactly as in kernels and have no arithmetic of their own. (char,
// uchar, short and ushort are std::int8_t to std::uint16_t.)
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace sk {

/// IEEE 754's binary16. Conversion from float rounds to nearest, ties to even; values that round beyond 65504
/// become infinity, and NaN stays NaN.
class half {
 public:
  half() = default;
  constexpr half(float value) : bits_(nearest(std::bit_cast<std::uint32_t>(value))) {}
  constexpr operator float() const {
    const std::uint32_t sign = (bits_ & 0x8000u) << 16;
    const std::uint32_t magnitude = bits_ & 0x7fffu;
    if (magnitude >= 0x7c00u) return std::bit_cast<float>(sign | 0x7f800000u | (magnitude & 0x3ffu) << 13);
    if (magnitude < 0x400u) {  // a denormal
      const float value = static_cast<float>(magnitude) * 0x1p-24f;
      return sign != 0 ? -value : value;
    }
    return std::bit_cast<float>(sign | ((magnitude << 13) + (112u << 23)));
  }

  static constexpr half fromBits(std::uint16_t bits) {
    half result;
    result.bits_ = bits;
    return result;
  }
  constexpr std::uint16_t bits() const { return bits_; }

 private:
  static constexpr std::uint16_t nearest(std::uint32_t bits) {
    const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000u);
    const std::uint32_t magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u)
      return static_cast<std::uint16_t>(sign | 0x7e00u | (magnitude >> 13 & 0x3ffu));
    if (magnitude < 0x38800000u) return static_cast<std::uint16_t>(sign | denormal(magnitude));
    const std::uint32_t rounded = (magnitude + 0xfffu + (magnitude >> 13 & 1u)) >> 13;
    const std::uint32_t half = rounded - (112u << 10);
    return static_cast<std::uint16_t>(sign | (half > 0x7c00u ? 0x7c00u : half));
  }
  /// The multiple of 2^-24 nearest to a float of magnitude below 2^-14.
  static constexpr std::uint32_t denormal(std::uint32_t magnitude) {
    const std::uint32_t exponent = magnitude >> 23;
    if (exponent < 102) return 0;  // below 2^-25
    const std::uint32_t mantissa = (magnitude & 0x7fffffu) | 0x800000u;
    const std::uint32_t shift = 126 - exponent;
    const std::uint32_t whole = mantissa >> shift;
    const std::uint32_t rest = mantissa & ((1u << shift) - 1);
    const std::uint32_t middle = 1u << (shift - 1);
    return whole + (rest > middle || (rest == middle && (whole & 1u) != 0) ? 1 : 0);
  }

  std::uint16_t bits_;
};

/// Represents k / max by an integer k from 0 (unsigned Integer) or -max (signed) to max. Conversion from
/// float x rounds the float product x * max to the nearest k, ties to even; values out of range are clamped,
/// and NaN becomes 0.
template <class Integer>
class Normalized {
 public:
  static constexpr float scale = std::numeric_limits<Integer>::max();

  Normalized() = default;
  constexpr Normalized(float value) : integer_(nearest(value)) {}
  constexpr operator float() const {
    const float value = static_cast<float>(integer_) / scale;
    return value < -1.0f ? -1.0f : value;  // the integer -max - 1, too
  }

  static constexpr Normalized fromInteger(Integer integer) {
    Normalized result;
    result.integer_ = integer;
    return result;
  }
  constexpr Integer integer() const { return integer_; }

 private:
  static constexpr Integer nearest(float value) {
    constexpr float least = std::is_signed_v<Integer> ? -1.0f : 0.0f;
    if (!(value > least)) return value <= least ? static_cast<Integer>(least * scale) : Integer{0};
    const float product = (value < 1.0f ? value : 1.0f) * scale;
    auto whole = static_cast<std::int32_t>(product);
    const float rest = product - static_cast<float>(whole);
    const bool isOdd = (whole & 1) != 0;
    if (rest > 0.5f || (rest == 0.5f && isOdd)) ++whole;
    if (rest < -0.5f || (rest == -0.5f && isOdd)) --whole;
    return static_cast<Integer>(whole);
  }

  Integer integer_;
};

using unorm8 = Normalized<std::uint8_t>;
using snorm8 = Normalized<std::int8_t>;
using unorm16 = Normalized<std::uint16_t>;
using snorm16 = Normalized<std::int16_t>;

}  // namespace sk
