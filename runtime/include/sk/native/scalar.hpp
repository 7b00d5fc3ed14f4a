// SPDX-License-Identifier: MIT
//
// Scalars of the language in native code, and conversions between all of them. Kernels are templates over
// their real type, so that one text computes in float or, as its own reference, in double.
#pragma once

#include <bit>
#include <cstdint>

#include "sk/narrow.hpp"
#include "sk/native/integer.hpp"
#include "sk/native/vector.hpp"

namespace sk::native {

/// What `double` is where `float` is Real: as exact, at least.
template <class Real>
struct WideOf {
  using Type = double;
};
template <class Real>
using Wide = typename WideOf<Real>::Type;

/// A scalar that only keeps values: a Host in memory, computed with as a Carrier.
template <class Host, class Carrier>
class Narrow {
 public:
  using HostType = Host;
  using CarrierType = Carrier;

  Narrow() = default;
  explicit constexpr Narrow(Carrier value) : host_(stored(value)) {}
  explicit constexpr operator Carrier() const {
    if constexpr (isInteger<Carrier>) {
      return Carrier(host_);
    } else {
      return static_cast<Carrier>(static_cast<float>(host_));
    }
  }

 private:
  static constexpr Host stored(Carrier value) {
    if constexpr (isInteger<Carrier>) {
      return static_cast<Host>(value.word());
    } else {
      return Host(static_cast<float>(value));
    }
  }

  Host host_;
};

template <class Real>
using Half = Narrow<half, Real>;
template <class Real>
using Unorm8 = Narrow<unorm8, Real>;
template <class Real>
using Snorm8 = Narrow<snorm8, Real>;
template <class Real>
using Unorm16 = Narrow<unorm16, Real>;
template <class Real>
using Snorm16 = Narrow<snorm16, Real>;
using Char = Narrow<std::int8_t, Int>;
using Uchar = Narrow<std::uint8_t, Int>;
using Short = Narrow<std::int16_t, Int>;
using Ushort = Narrow<std::uint16_t, Int>;

template <class T>
inline constexpr bool isNarrow = false;
template <class Host, class Carrier>
inline constexpr bool isNarrow<Narrow<Host, Carrier>> = true;

/// The float that the half becomes which a float becomes (sk::half): without a branch, so that loops have vectors of it.
inline float halfRounded(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t sign = bits & 0x80000000U;
  const std::uint32_t magnitude = bits ^ sign;
  const std::uint32_t normal = (magnitude + 0xfffU + (magnitude >> 13 & 1U)) & ~0x1fffU;
  // the unit of a float at 1/2 is that of denormal halves, 2^-24
  const auto denormal = std::bit_cast<std::uint32_t>((std::bit_cast<float>(magnitude) + 0.5F) - 0.5F);
  const std::uint32_t nan = (magnitude | 0x7fc00000U) & ~0x1fffU;
  std::uint32_t rounded = normal > 0x477fe000U ? 0x7f800000U : normal;  // beyond 65504
  rounded = magnitude < 0x38800000U ? denormal : rounded;
  rounded = magnitude > 0x7f800000U ? nan : rounded;
  return std::bit_cast<float>(rounded | sign);
}

/// The language's conversion of a scalar, or of the components of a vector.
template <class To, class From>
constexpr To convert(const From& from) {
  if constexpr (Vector<To>) {
    To result;
    for (std::size_t i = 0; i < widthOf<To>; ++i) {
      result.components[i] = convert<Component<To>>(componentAt(from, i));
    }
    return result;
  } else if constexpr (std::is_same_v<To, From>) {
    return from;
  } else if constexpr (isNarrow<From>) {
    return convert<To>(static_cast<typename From::CarrierType>(from));
  } else if constexpr (isNarrow<To>) {
    return To(convert<typename To::CarrierType>(from));
  } else if constexpr (std::is_same_v<To, bool>) {
    return from != From(0);
  } else if constexpr (isInteger<To>) {
    if constexpr (isInteger<From> || std::is_same_v<From, bool>) {
      return To(from);
    } else {
      return truncated<decltype(To().word())>(from);
    }
  } else if constexpr (isInteger<From>) {
    return static_cast<To>(from.word());
  } else {
    return static_cast<To>(from);
  }
}

}  // namespace sk::native
