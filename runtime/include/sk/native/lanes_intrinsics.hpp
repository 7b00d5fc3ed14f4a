// SPDX-License-Identifier: MIT
//
// The intrinsics of intrinsics.hpp for values of lanes (lanes.hpp), as far as they are worth vectors: those of its templates that serve
// lanes as they serve scalars find the functions here. All others are computed lane by lane. compiler/emit/native_lanes.cpp
// knows which are which.
#pragma once

#include <concepts>
#include <limits>

#include "sk/native/intrinsics.hpp"
#include "sk/native/lanes.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // as in lanes.hpp

namespace sk::native {

using Floats = Lanes<float>;

// ---- bits ---------------------------------------------------------------------------------------

inline Lanes<Uint> bitsOf(const Floats& x) {
  return Lanes<Uint>::byPart([](const Part<float>& part) { return part; }, x);
}
inline Floats floatsOf(const Lanes<Uint>& x) {
  return Floats::byPart([](const Bits& part) { return part; }, x);
}
inline Mask hasSign(const Floats& x) {
  return Mask::byPart([](const Part<float>& part) { return (Truth)part >> 31; }, x);
}
/// |x| with the sign of `sign`, of what has none itself.
inline Floats signedAs(const Floats& x, const Floats& sign) {
  return floatsOf(bitsOf(x) | (bitsOf(sign) & Uint(0x80000000U)));
}

// clang-format off: one function a line
template <OfLanes A> auto floatBitsToUint(const A& a) { return byComponent([](const Floats& x) { return bitsOf(x); }, a); }
template <OfLanes A> auto floatBitsToInt(const A& a) { return convertLanes<Int>(floatBitsToUint(a)); }
template <OfLanes A> auto asInt(const A& a) { return floatBitsToInt(a); }
template <OfLanes A> auto asUint(const A& a) { return floatBitsToUint(a); }
template <class Real, OfLanes A> auto intBitsToFloat(const A& a) { return byComponent([](const auto& x) { return floatsOf(convertLanes<Uint>(x)); }, a); }
template <class Real, OfLanes A> auto uintBitsToFloat(const A& a) { return intBitsToFloat<Real>(a); }
template <class Real, OfLanes A> auto asFloatInt(const A& a) { return intBitsToFloat<Real>(a); }
template <class Real, OfLanes A> auto asFloatUint(const A& a) { return intBitsToFloat<Real>(a); }
// clang-format on

// ---- the C library's ----------------------------------------------------------------------------

template <>
struct Math<Floats> {
  static Floats fabs(const Floats& x) { return floatsOf(bitsOf(x) & Uint(0x7fffffffU)); }
  static Mask signbit(const Floats& x) { return hasSign(x); }
  static Mask isinf(const Floats& x) { return fabs(x) == std::numeric_limits<float>::infinity(); }
  static Mask isfinite(const Floats& x) { return fabs(x) < std::numeric_limits<float>::infinity(); }
  static Floats sqrt(const Floats& x) {
#if defined(__SSE__)
    using Quarter [[gnu::vector_size(16)]] = float;
    return Floats::byPart(
        [](const Part<float>& part) {
          const Quarter low = __builtin_ia32_sqrtps(__builtin_shufflevector(part, part, 0, 1, 2, 3));
          const Quarter high = __builtin_ia32_sqrtps(__builtin_shufflevector(part, part, 4, 5, 6, 7));
          return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
        },
        x);
#else
    return laneByLane([](float lane) { return Math<float>::sqrt(lane); }, x);
#endif
  }
  static Floats trunc(const Floats& x) { return whole(x, towardsZero(x)); }
  static Floats floor(const Floats& x) {
    const Floats t = towardsZero(x);
    return whole(x, select(t > x, t - 1.0F, t));
  }
  static Floats ceil(const Floats& x) {
    const Floats t = towardsZero(x);
    return whole(x, select(t < x, t + 1.0F, t));
  }
  /// Adding what leaves a float no fraction rounds to even.
  static Floats nearbyint(const Floats& x) {
    const Floats shift = signedAs(Floats(0x1p23F), x);
    return whole(x, (x + shift) - shift);
  }

 private:
  static Floats towardsZero(const Floats& x) { return convertLanes<float>(convertLanes<Int>(x)); }
  /// `rounded` with the sign of x, which a zero has lost; x where it is large, and so whole, or no number.
  static Floats whole(const Floats& x, const Floats& rounded) {
    return select(fabs(x) < 0x1p23F, signedAs(rounded, x), x);
  }
};

// ---- what intrinsics.hpp says by conditions -----------------------------------------------------

template <class T>
Lanes<T> absOf(const Lanes<T>& x) {
  if constexpr (isInteger<T>) {
    return select(x < T(0), -x, x);
  } else {
    return Math<Floats>::fabs(x);
  }
}
template <class T>
Lanes<T> signOf(const Lanes<T>& x) {
  const Lanes<T> zero(T(0));
  return select(x > zero, Lanes<T>(T(1)), select(x < zero, Lanes<T>(T(-1)), zero));
}
template <class T>
Lanes<T> minOf(const Lanes<T>& x, const Lanes<T>& y) {
  if constexpr (isInteger<T>) {
    return select(y < x, y, x);
  } else {
    return select(x == y, select(hasSign(x), x, y), select((x < y) | (y != y), x, y));
  }
}
template <class T>
Lanes<T> maxOf(const Lanes<T>& x, const Lanes<T>& y) {
  if constexpr (isInteger<T>) {
    return select(x < y, y, x);
  } else {
    return select(x == y, select(hasSign(x), y, x), select((x > y) | (y != y), x, y));
  }
}
inline Floats fractOf(const Floats& x) {
  const Floats fraction = x - Math<Floats>::floor(x);
  const Floats below = select(fraction >= 1.0F, Floats(0x1.fffffep-1F), fraction);
  return select(Math<Floats>::isinf(x), Floats(std::numeric_limits<float>::quiet_NaN()), below);
}
inline Floats lengthScale(const Floats& most) {
  return select(most >= 0x1p62F, Floats(0x1p-66F), select(most < 0x1p-40F, Floats(0x1p86F), Floats(1.0F)));
}
template <class A>
  requires std::same_as<Component<A>, Floats>
Floats length(const A& a) {
  const Floats most = largest(a);
  const Floats scale = lengthScale(most);
  const A scaled = a * scale;
  return select(Math<Floats>::isinf(most), most, Math<Floats>::sqrt(dot(scaled, scaled)) / scale);
}
template <class A>
  requires std::same_as<Component<A>, Floats>
A normalize(const A& a) {
  const A scaled = a * lengthScale(largest(a));
  const Floats square = dot(scaled, scaled);
  return select(square == 0.0F, a, A(scaled / Math<Floats>::sqrt(square)));
}

// clang-format off: one function a line
template <OfLanes A> auto isnan(const A& a) { return byComponent([](const Floats& x) { return x != x; }, a); }
template <OfLanes A> auto isinf(const A& a) { return byComponent([](const Floats& x) { return Math<Floats>::isinf(x); }, a); }
template <OfLanes A> auto isfinite(const A& a) { return byComponent([](const Floats& x) { return Math<Floats>::isfinite(x); }, a); }
template <OfLanes A, OfLanes B, OfLanes C> auto mixBool(const A& x, const B& y, const C& z) { return select(z, y, x); }
template <OfLanes A, OfLanes B> auto step(const A& edge, const B& a) { return byComponent([](const Floats& x, const Floats& y) { return select(y < x, Floats(0.0F), Floats(1.0F)); }, edge, a); }
// clang-format on

}  // namespace sk::native

#pragma GCC diagnostic pop
