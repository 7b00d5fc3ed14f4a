// SPDX-License-Identifier: MIT
//
// What the generated programs use of .sk, for Clang: compiled with this header, their meaning is that of C++.
#pragma once

using uint = unsigned;
using uchar = unsigned char;
using ushort = unsigned short;
using ulong = unsigned long;

#define SK_VECTOR(name, element, width)                                \
  typedef element name##width __attribute__((ext_vector_type(width))); \
  typedef name##width name##width##_t;  // in front of a parenthesis
#define SK_VECTORS(name, element) \
  SK_VECTOR(name, element, 2) SK_VECTOR(name, element, 3) SK_VECTOR(name, element, 4)
SK_VECTORS(int, int)
SK_VECTORS(uint, unsigned)
SK_VECTORS(float, float)
SK_VECTORS(double, double)
SK_VECTORS(char, char)
SK_VECTORS(uchar, unsigned char)
SK_VECTORS(short, short)
SK_VECTORS(ushort, unsigned short)
SK_VECTORS(long, long)
SK_VECTORS(ulong, unsigned long)

template <class V>
inline constexpr int width_of = 1;
template <class T, int n>
inline constexpr int width_of<T __attribute__((ext_vector_type(n)))> = n;

/// `float4(v.xy, 1, 2)`: from parts, or the same number everywhere.
template <class V, class... Parts>
V make(Parts... parts) {
  V result;
  int next = 0;
  const auto add = [&](auto part) {
    if constexpr (width_of<decltype(part)> == 1) {
      result[next++] = part;
    } else {
      for (int i = 0; i < width_of<decltype(part)>; ++i) result[next++] = part[i];
    }
  };
  if constexpr (sizeof...(Parts) == 1) {
    const auto all = [&](auto part) {
      if constexpr (width_of<decltype(part)> == 1) {
        for (int i = 0; i < width_of<V>; ++i) result[i] = part;
      } else {
        for (int i = 0; i < width_of<V>; ++i) result[i] = part[i];
      }
    };
    (all(parts), ...);
  } else {
    (add(parts), ...);
  }
  return result;
}

template <class Row, int size>
struct Matrix {
  Row rows[size];
  Matrix() = default;
  template <class... Parts>
  Matrix(Parts... parts) {
    const auto all = make<float __attribute__((ext_vector_type(size * size)))>(parts...);
    for (int i = 0; i < size * size; ++i) rows[i / size][i % size] = all[i];
  }
  Row& operator[](int i) { return rows[i]; }
  const Row& operator[](int i) const { return rows[i]; }
};
using float2x2 = Matrix<float2, 2>;
using float3x3 = Matrix<float3, 3>;
using float4x4 = Matrix<float4, 4>;

template <class T>
T min(T a, T b) {
  return b < a ? b : a;
}
template <class T>
T max(T a, T b) {
  return a < b ? b : a;
}
template <class T>
T clamp(T x, T low, T high) {
  return min(max(x, low), high);
}
template <class T>
T abs(T x) {
  return x < 0 ? -x : x;
}
inline int popcount(uint x) { return __builtin_popcount(x); }
inline int clz(uint x) { return x == 0 ? 32 : __builtin_clz(x); }
inline int ctz(uint x) { return x == 0 ? 32 : __builtin_ctz(x); }
inline int mulhi(int a, int b) { return static_cast<int>(static_cast<long long>(a) * b >> 32); }
inline uint mulhi(uint a, uint b) { return static_cast<uint>(static_cast<unsigned long long>(a) * b >> 32); }
inline float floor(float x) { return __builtin_floorf(x); }
inline float ceil(float x) { return __builtin_ceilf(x); }
inline float trunc(float x) { return __builtin_truncf(x); }
inline float round(float x) { return __builtin_rintf(x); }
inline double floor(double x) { return __builtin_floor(x); }
inline double ceil(double x) { return __builtin_ceil(x); }
inline double trunc(double x) { return __builtin_trunc(x); }
inline double round(double x) { return __builtin_rint(x); }

// Functions that round: programs look at a few bits of their results only.
#define SK_FUNCTION(name)                                      \
  inline double name(double x) { return __builtin_##name(x); } \
  inline float name(float x) { return static_cast<float>(__builtin_##name(double(x))); }
#define SK_FUNCTION_OF_TWO(name)                                            \
  inline double name(double x, double y) { return __builtin_##name(x, y); } \
  inline float name(float x, float y) { return static_cast<float>(__builtin_##name(double(x), double(y))); }
// clang-format off
SK_FUNCTION(atan)
SK_FUNCTION(cbrt)
SK_FUNCTION(cos)
SK_FUNCTION(erf)
SK_FUNCTION(erfc)
SK_FUNCTION(exp)
SK_FUNCTION(exp2)
SK_FUNCTION(expm1)
SK_FUNCTION(log)
SK_FUNCTION(log1p)
SK_FUNCTION(log2)
SK_FUNCTION(sin)
SK_FUNCTION(sqrt)
SK_FUNCTION(tanh)
SK_FUNCTION_OF_TWO(atan2)
SK_FUNCTION_OF_TWO(hypot)
SK_FUNCTION_OF_TWO(pow)
// clang-format on
/// A literal exponent is a float beside a float.
template <class F, class E>
  requires(__is_same(F, float))
float pow(F x, E y) {
  return pow(x, static_cast<float>(y));
}

/// The vector type with this component.
template <class T, int n>
using vector_of = T __attribute__((ext_vector_type(n)));
/// Calls a function for each component of its vectors.
template <class Function, class V, class... Others>
auto by_component(Function function, V first, Others... others) {
  vector_of<decltype(function(first[0], others[0]...)), width_of<V>> result;
  for (int i = 0; i < width_of<V>; ++i) result[i] = function(first[i], others[i]...);
  return result;
}
#define SK_OF_VECTORS(name)                                 \
  template <class V>                                        \
    requires(width_of<V> > 1)                               \
  auto name(V v) {                                          \
    return by_component([](auto x) { return name(x); }, v); \
  }
#define SK_OF_TWO_VECTORS(name)                                           \
  template <class V>                                                      \
    requires(width_of<V> > 1)                                             \
  auto name(V v, V w) {                                                   \
    return by_component([](auto x, auto y) { return name(x, y); }, v, w); \
  }
// clang-format off
SK_OF_VECTORS(popcount)
SK_OF_VECTORS(clz)
SK_OF_VECTORS(ctz)
SK_OF_VECTORS(floor)
SK_OF_VECTORS(ceil)
SK_OF_VECTORS(trunc)
SK_OF_VECTORS(round)
SK_OF_VECTORS(atan)
SK_OF_VECTORS(cbrt)
SK_OF_VECTORS(cos)
SK_OF_VECTORS(erf)
SK_OF_VECTORS(erfc)
SK_OF_VECTORS(exp)
SK_OF_VECTORS(exp2)
SK_OF_VECTORS(expm1)
SK_OF_VECTORS(log)
SK_OF_VECTORS(log1p)
SK_OF_VECTORS(log2)
SK_OF_VECTORS(sin)
SK_OF_VECTORS(sqrt)
SK_OF_VECTORS(tanh)
SK_OF_TWO_VECTORS(mulhi)
SK_OF_TWO_VECTORS(atan2)
SK_OF_TWO_VECTORS(hypot)
SK_OF_TWO_VECTORS(pow)
// clang-format on

template <class T>
T fract(T x) {
  return x - floor(x);
}
/// What is done with a mask.
template <class Mask, class V>
V select(Mask mask, V yes, V no) {
  for (int i = 0; i < width_of<V>; ++i) yes[i] = mask[i] ? yes[i] : no[i];
  return yes;
}
template <class Mask>
bool any(Mask mask) {
  bool result = false;
  for (int i = 0; i < width_of<Mask>; ++i) result |= mask[i] != 0;
  return result;
}
template <class Mask>
bool all(Mask mask) {
  bool result = true;
  for (int i = 0; i < width_of<Mask>; ++i) result &= mask[i] != 0;
  return result;
}

#include "streams_as_cpp.hpp"

/// Makes a kernel without parameters of its own callable for many elements.
#define SK_KERNEL(name) \
  extern "C" void run_##name(SK_RUN_PARAMETERS) { SK_RUN(1, name(a[i], b[i], c[i], r0[i], r1[i], r2[i])) }

// Macros without an argument list leave the types alone.
#define int2(...) make<int2>(__VA_ARGS__)
#define int3(...) make<int3>(__VA_ARGS__)
#define int4(...) make<int4>(__VA_ARGS__)
#define uint2(...) make<uint2>(__VA_ARGS__)
#define uint3(...) make<uint3>(__VA_ARGS__)
#define uint4(...) make<uint4>(__VA_ARGS__)
#define float2(...) make<float2>(__VA_ARGS__)
#define float3(...) make<float3>(__VA_ARGS__)
#define float4(...) make<float4>(__VA_ARGS__)
#define double2(...) make<double2>(__VA_ARGS__)
#define double3(...) make<double3>(__VA_ARGS__)
#define double4(...) make<double4>(__VA_ARGS__)
#define char2(...) make<char2>(__VA_ARGS__)
#define char3(...) make<char3>(__VA_ARGS__)
#define char4(...) make<char4>(__VA_ARGS__)
#define uchar2(...) make<uchar2>(__VA_ARGS__)
#define uchar3(...) make<uchar3>(__VA_ARGS__)
#define uchar4(...) make<uchar4>(__VA_ARGS__)
#define short2(...) make<short2>(__VA_ARGS__)
#define short3(...) make<short3>(__VA_ARGS__)
#define short4(...) make<short4>(__VA_ARGS__)
#define ushort2(...) make<ushort2>(__VA_ARGS__)
#define ushort3(...) make<ushort3>(__VA_ARGS__)
#define ushort4(...) make<ushort4>(__VA_ARGS__)
#define long2(...) make<long2>(__VA_ARGS__)
#define long3(...) make<long3>(__VA_ARGS__)
#define long4(...) make<long4>(__VA_ARGS__)
#define ulong2(...) make<ulong2>(__VA_ARGS__)
#define ulong3(...) make<ulong3>(__VA_ARGS__)
#define ulong4(...) make<ulong4>(__VA_ARGS__)
