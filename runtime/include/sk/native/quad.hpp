// SPDX-License-Identifier: MIT
//
// A real type of 113 bits, which the widest reference computes with: IEEE 754's binary128, by libquadmath where that is
// __float128, else long double (AArch64). Only native code that skc was asked for (--quad) has a use for its functions.
#pragma once

#if defined(__SIZEOF_FLOAT128__)
#include <quadmath.h>
#endif

#include "sk/native/math.hpp"
#include "sk/native/quad_type.hpp"
#include "sk/native/scalar.hpp"

namespace sk::native {

template <>
struct WideOf<Quad> {
  using Type = Quad;
};

#if defined(__SIZEOF_FLOAT128__)
#define SK_NATIVE_QUAD_1(name) \
  static Quad name(Quad x) { return name##q(x); }
#define SK_NATIVE_QUAD_2(name) \
  static Quad name(Quad x, Quad y) { return name##q(x, y); }
template <>
struct Math<Quad> {
  SK_NATIVE_REAL_FUNCTIONS(SK_NATIVE_QUAD_1, SK_NATIVE_QUAD_2)
  static Quad fma(Quad x, Quad y, Quad z) { return fmaq(x, y, z); }
  static Quad ldexp(Quad x, int e) { return ldexpq(x, e); }
  static Quad frexp(Quad x, int* e) { return frexpq(x, e); }
  static bool isinf(Quad x) { return isinfq(x) != 0; }
  static bool isfinite(Quad x) { return finiteq(x) != 0; }
  static bool signbit(Quad x) { return signbitq(x) != 0; }
};
#undef SK_NATIVE_QUAD_1
#undef SK_NATIVE_QUAD_2
#endif

}  // namespace sk::native
