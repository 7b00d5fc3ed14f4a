// SPDX-License-Identifier: MIT
//
// The intrinsics of the language in native code, by the names of compiler/ir/intrinsics.def with a small first
// letter. Those of real numbers are the C library's, in the precision of their argument: correctly rounded or
// within an ulp or two (glibc), over their whole range.
#pragma once

#include <bit>
#include <limits>
#include <type_traits>

#include "sk/native/math.hpp"
#include "sk/native/scalar.hpp"
#include "sk/native/vector.hpp"

namespace sk::native {

// clang-format off: one function a line

#define SK_NATIVE_1(name, expression) \
  template <class A> auto name(const A& a) { return byComponent([](auto x) { return decltype(x)(expression); }, a); }
#define SK_NATIVE_2(name, expression) \
  template <class A, class B> auto name(const A& a, const B& b) { return byComponent([](auto x, auto y) { return decltype(x)(expression); }, a, b); }
#define SK_NATIVE_3(name, expression) \
  template <class A, class B, class C> auto name(const A& a, const B& b, const C& c) { return byComponent([](auto x, auto y, auto z) { return decltype(x)(expression); }, a, b, c); }

// angles and trigonometry
SK_NATIVE_1(radians, x * decltype(x)(0.017453292519943295769L))
SK_NATIVE_1(degrees, x * decltype(x)(57.295779513082320877L))
SK_NATIVE_1(sin, Math<decltype(x)>::sin(x))
SK_NATIVE_1(cos, Math<decltype(x)>::cos(x))
SK_NATIVE_1(tan, Math<decltype(x)>::tan(x))
SK_NATIVE_1(asin, Math<decltype(x)>::asin(x))
SK_NATIVE_1(acos, Math<decltype(x)>::acos(x))
SK_NATIVE_1(atan, Math<decltype(x)>::atan(x))
SK_NATIVE_2(atanYX, Math<decltype(x)>::atan2(x, y))
SK_NATIVE_2(atan2, Math<decltype(x)>::atan2(x, y))
SK_NATIVE_1(sinh, Math<decltype(x)>::sinh(x))
SK_NATIVE_1(cosh, Math<decltype(x)>::cosh(x))
SK_NATIVE_1(tanh, Math<decltype(x)>::tanh(x))
SK_NATIVE_1(asinh, Math<decltype(x)>::asinh(x))
SK_NATIVE_1(acosh, Math<decltype(x)>::acosh(x))
SK_NATIVE_1(atanh, Math<decltype(x)>::atanh(x))

// exponential
SK_NATIVE_2(pow, Math<decltype(x)>::pow(x, y))
SK_NATIVE_1(exp, Math<decltype(x)>::exp(x))
SK_NATIVE_1(log, Math<decltype(x)>::log(x))
SK_NATIVE_1(exp2, Math<decltype(x)>::exp2(x))
SK_NATIVE_1(log2, Math<decltype(x)>::log2(x))
SK_NATIVE_1(log10, Math<decltype(x)>::log10(x))
SK_NATIVE_1(sqrt, Math<decltype(x)>::sqrt(x))
SK_NATIVE_1(inverseSqrt, decltype(x)(1) / Math<decltype(x)>::sqrt(x))
SK_NATIVE_1(rsqrt, decltype(x)(1) / Math<decltype(x)>::sqrt(x))

// common
template <class T> T absOf(T x) { if constexpr (isInteger<T>) { return x < T(0) ? -x : x; } else { return Math<T>::fabs(x); } }
template <class T> T signOf(T x) { return x > T(0) ? T(1) : x < T(0) ? T(-1) : T(0); }
/// IEEE 754's minNum and maxNum: of a number and a NaN, the number; -0 is below +0.
template <class T> T minOf(T x, T y) {
  if constexpr (isInteger<T>) { return y < x ? y : x; } else { return x == y ? (Math<T>::signbit(x) ? x : y) : x < y || y != y ? x : y; }
}
template <class T> T maxOf(T x, T y) {
  if constexpr (isInteger<T>) { return x < y ? y : x; } else { return x == y ? (Math<T>::signbit(x) ? y : x) : x > y || y != y ? x : y; }
}
/// Below 1, also where x is a little less than a whole number.
template <class T> T fractOf(T x) {
  if (Math<T>::isinf(x)) return T(std::numeric_limits<float>::quiet_NaN());
  const T fraction = x - Math<T>::floor(x);
  return fraction >= T(1) ? Math<T>::nextafter(T(1), T(0)) : fraction;
}
/// What is left of x by y, exact but for the sum that gives it the sign of y.
template <class T> T modOf(T x, T y) {
  const T left = Math<T>::fmod(x, y);
  return left != T(0) && (left < T(0)) != (y < T(0)) ? left + y : left;
}
template <class T> T mixOf(T x, T y, T t) { return x * (T(1) - t) + y * t; }
template <class T> T smoothstepOf(T low, T high, T x) {
  const T t = minOf(maxOf((x - low) / (high - low), T(0)), T(1));
  return t * t * (T(3) - T(2) * t);
}
SK_NATIVE_1(abs, absOf(x))
SK_NATIVE_1(fabs, absOf(x))
SK_NATIVE_1(sign, signOf(x))
SK_NATIVE_1(floor, Math<decltype(x)>::floor(x))
SK_NATIVE_1(trunc, Math<decltype(x)>::trunc(x))
SK_NATIVE_1(round, Math<decltype(x)>::nearbyint(x))
SK_NATIVE_1(roundEven, Math<decltype(x)>::nearbyint(x))
SK_NATIVE_1(ceil, Math<decltype(x)>::ceil(x))
SK_NATIVE_1(fract, fractOf(x))
SK_NATIVE_1(frac, fractOf(x))
SK_NATIVE_2(mod, modOf(x, y))
SK_NATIVE_2(fmod, Math<decltype(x)>::fmod(x, y))
SK_NATIVE_2(min, minOf(x, y))
SK_NATIVE_2(max, maxOf(x, y))
SK_NATIVE_2(fmin, minOf(x, y))
SK_NATIVE_2(fmax, maxOf(x, y))
SK_NATIVE_3(clamp, minOf(maxOf(x, y), z))
SK_NATIVE_1(saturate, minOf(maxOf(x, decltype(x)(0)), decltype(x)(1)))
SK_NATIVE_3(mix, mixOf(x, y, z))
SK_NATIVE_3(mixBool, z ? y : x)
SK_NATIVE_3(lerp, mixOf(x, y, z))
SK_NATIVE_2(step, y < x ? decltype(x)(0) : decltype(x)(1))
SK_NATIVE_3(smoothstep, smoothstepOf(x, y, z))
SK_NATIVE_3(fma, x * y + z)
template <class A> auto isnan(const A& a) { return byComponent([](auto x) { return bool(x != x); }, a); }
template <class A> auto isinf(const A& a) { return byComponent([](auto x) { return bool(Math<decltype(x)>::isinf(x)); }, a); }
template <class A> auto isfinite(const A& a) { return byComponent([](auto x) { return bool(Math<decltype(x)>::isfinite(x)); }, a); }

// bits: of the float that is nearest, where the real type is wider. The way back needs to know that type.
inline Uint bitsOf(float x) { return Uint(std::bit_cast<std::uint32_t>(x)); }
inline float floatOf(Uint x) { return std::bit_cast<float>(x.word()); }
template <class A> auto floatBitsToInt(const A& a) { return byComponent([](auto x) { return Int(bitsOf(static_cast<float>(x))); }, a); }
template <class A> auto floatBitsToUint(const A& a) { return byComponent([](auto x) { return bitsOf(static_cast<float>(x)); }, a); }
template <class A> auto asInt(const A& a) { return floatBitsToInt(a); }
template <class A> auto asUint(const A& a) { return floatBitsToUint(a); }
template <class Real, class A> auto intBitsToFloat(const A& a) { return byComponent([](auto x) { return Real(floatOf(Uint(x))); }, a); }
template <class Real, class A> auto uintBitsToFloat(const A& a) { return intBitsToFloat<Real>(a); }
template <class Real, class A> auto asFloatInt(const A& a) { return intBitsToFloat<Real>(a); }
template <class Real, class A> auto asFloatUint(const A& a) { return intBitsToFloat<Real>(a); }
SK_NATIVE_2(ldexp, Math<decltype(x)>::ldexp(x, y.word()))
template <class T> Int exponentOf(T x) {
  int e = 0;
  if (x != T(0) && Math<T>::isfinite(x)) Math<T>::frexp(x, &e);
  return Int(e);
}
template <class T> T mantissaOf(T x) {
  int e = 0;
  return x == T(0) || !Math<T>::isfinite(x) ? x : Math<T>::frexp(x, &e);
}
template <class A> auto frexpExponent(const A& a) { return byComponent([](auto x) { return exponentOf(x); }, a); }
SK_NATIVE_1(frexpMantissa, mantissaOf(x))
SK_NATIVE_1(modfFraction, Math<decltype(x)>::copysign(Math<decltype(x)>::isinf(x) ? decltype(x)(0) : x - Math<decltype(x)>::trunc(x), x))
SK_NATIVE_1(roundedToHalf, halfRounded(static_cast<float>(x)))
template <class A> auto nearest(const A& a) { return byComponent([](auto x) { return wholeIndex(Math<decltype(x)>::floor(x + decltype(x)(0.5))); }, a); }

// what a rounding loses: IEEE 754's arithmetic leaves it a float (Knuth, TAOCP 2, 4.2.2; Dekker,
// Numer. Math. 18, 1971)
template <class T> T sumErrorOf(T a, T b) {
  const T s = a + b;
  const T c = s - a;
  return (a - (s - c)) + (b - c);
}
/// Of a product that is not finite, 0.
template <class T> T productErrorOf(T a, T b) {
  const T p = a * b;
  if constexpr (std::is_same_v<T, float>) {
    const auto error = static_cast<float>(double{a} * double{b} - double{p});
    return Math<T>::isfinite(p) ? error : T(0);
  } else {
    return Math<T>::isfinite(p) ? Math<T>::fma(a, b, -p) : T(0);
  }
}
SK_NATIVE_2(roundedProduct, x * y)
SK_NATIVE_2(productError, productErrorOf(x, y))
SK_NATIVE_2(roundedSum, x + y)
SK_NATIVE_2(sumError, sumErrorOf(x, y))

// geometry
template <class A> auto dot(const A& a, const A& b) {
  auto sum = componentAt(a, 0) * componentAt(b, 0);
  for (std::size_t i = 1; i < widthOf<A>; ++i) sum = sum + componentAt(a, i) * componentAt(b, i);
  return sum;
}
/// A power of 2 by which vectors with this largest component are multiplied, so that no square overflows or vanishes. All
/// of its values are in the range of float, whose powers of 2 they are.
template <class T> T lengthScale(T most) {
  return most >= T(0x1p62F) ? T(0x1p-66F) : most < T(0x1p-40F) ? T(0x1p86F) : T(1);
}
template <class A> auto largest(const A& a) {
  auto most = absOf(componentAt(a, 0));
  for (std::size_t i = 1; i < widthOf<A>; ++i) most = maxOf(most, absOf(componentAt(a, i)));
  return most;
}
template <class A> auto length(const A& a) {
  const auto most = largest(a);
  if (Math<Component<A>>::isinf(most)) return most;
  const auto scale = lengthScale(most);
  const A scaled = a * scale;
  return Math<Component<A>>::sqrt(dot(scaled, scaled)) / scale;
}
template <class A> auto distance(const A& a, const A& b) { return length(a - b); }
template <class T> auto cross(const Vec<T, 3>& a, const Vec<T, 3>& b) {
  return Vec<T, 3>(a[1] * b[2] - b[1] * a[2], a[2] * b[0] - b[2] * a[0], a[0] * b[1] - b[0] * a[1]);
}
/// Of zero, zero.
template <class A> A normalize(const A& a) {
  const A scaled = a * lengthScale(largest(a));
  const auto square = dot(scaled, scaled);
  return square == decltype(square)(0) ? a : A(scaled / Math<Component<A>>::sqrt(square));
}
template <class A> A faceforward(const A& n, const A& i, const A& reference) { return dot(reference, i) < Component<A>(0) ? n : A(-n); }
template <class A> A reflect(const A& i, const A& n) { return i - n * (Component<A>(2) * dot(n, i)); }
template <class A> A refract(const A& i, const A& n, const Component<A>& eta) {
  using Real = Component<A>;
  const Real d = dot(n, i);
  const Real k = Real(1) - eta * eta * (Real(1) - d * d);
  if (k < Real(0)) return A(Real(0));
  return i * eta - n * (eta * d + Math<Real>::sqrt(k));
}

// matrices
template <class T, std::size_t N> Mat<T, N> transpose(const Mat<T, N>& m) {
  Mat<T, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < N; ++k) result[i][k] = m[k][i];
  }
  return result;
}
/// Without a row and a column.
template <class T, std::size_t N> auto minorOf(const Mat<T, N>& m, std::size_t row, std::size_t column) {
  Mat<T, N - 1> part;
  for (std::size_t i = 0; i + 1 < N; ++i) {
    for (std::size_t k = 0; k + 1 < N; ++k) part.rows[i].components[k] = m.rows[i + (i >= row)].components[k + (k >= column)];
  }
  return part;
}
template <class T, std::size_t N> T determinant(const Mat<T, N>& m) {
  if constexpr (N == 2) {
    return m[0][0] * m[1][1] - m[0][1] * m[1][0];
  } else {
    T sum(0);
    for (std::size_t k = 0; k < N; ++k) {
      const T term = m[0][k] * determinant(minorOf(m, 0, k));
      sum = k % 2 == 0 ? sum + term : sum - term;
    }
    return sum;
  }
}
/// By cofactors, as GLSL's implementations do; of a singular one, infinities and NaN.
template <class T, std::size_t N> Mat<T, N> inverse(const Mat<T, N>& m) {
  const T d = determinant(m);
  Mat<T, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < N; ++k) {
      T cofactor;
      if constexpr (N == 2) { cofactor = m[1 - i][1 - k]; } else { cofactor = determinant(minorOf(m, i, k)); }
      result[k][i] = ((i + k) % 2 == 0 ? cofactor : -cofactor) / d;
    }
  }
  return result;
}

// comparisons of vectors
template <class A> auto lessThan(const A& a, const A& b) { return a < b; }
template <class A> auto lessThanEqual(const A& a, const A& b) { return a <= b; }
template <class A> auto greaterThan(const A& a, const A& b) { return a > b; }
template <class A> auto greaterThanEqual(const A& a, const A& b) { return a >= b; }
template <class A> auto equalTo(const A& a, const A& b) { return a == b; }
template <class A> auto notEqualTo(const A& a, const A& b) { return a != b; }
inline bool any(bool a) { return a; }
inline bool all(bool a) { return a; }
template <std::size_t N> bool any(const Vec<bool, N>& a) {
  for (const bool component : a.components) if (component) return true;
  return false;
}
template <std::size_t N> bool all(const Vec<bool, N>& a) {
  for (const bool component : a.components) if (!component) return false;
  return true;
}

#undef SK_NATIVE_1
#undef SK_NATIVE_2
#undef SK_NATIVE_3
// clang-format on

}  // namespace sk::native
