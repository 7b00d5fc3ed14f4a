// SPDX-License-Identifier: MIT
//
// The C library's functions of a real type, which intrinsics.hpp is made of. A real type that the standard library does
// not know has a specialisation (quad.hpp).
#pragma once

#include <cmath>

namespace sk::native {

/// one(name) for each function of one argument, two(name) for each of two.
#define SK_NATIVE_REAL_FUNCTIONS(one, two)                                                                  \
  one(sin) one(cos) one(tan) one(asin) one(acos) one(atan) one(sinh) one(cosh) one(tanh) one(asinh)         \
      one(acosh) one(atanh) one(exp) one(exp2) one(log) one(log2) one(log10) one(sqrt) one(fabs) one(floor) \
          one(ceil) one(trunc) one(nearbyint) two(atan2) two(pow) two(fmod) two(fmin) two(fmax)             \
              two(copysign) two(nextafter)

template <class Real>
struct Math {
#define SK_NATIVE_STD_1(name) \
  static Real name(Real x) { return std::name(x); }
#define SK_NATIVE_STD_2(name) \
  static Real name(Real x, Real y) { return std::name(x, y); }
  SK_NATIVE_REAL_FUNCTIONS(SK_NATIVE_STD_1, SK_NATIVE_STD_2)
#undef SK_NATIVE_STD_1
#undef SK_NATIVE_STD_2
  static Real fma(Real x, Real y, Real z) { return std::fma(x, y, z); }
  static Real ldexp(Real x, int e) { return std::ldexp(x, e); }
  static Real frexp(Real x, int* e) { return std::frexp(x, e); }
  static bool isinf(Real x) { return std::isinf(x); }
  static bool isfinite(Real x) { return std::isfinite(x); }
  static bool signbit(Real x) { return std::signbit(x); }
};

}  // namespace sk::native
