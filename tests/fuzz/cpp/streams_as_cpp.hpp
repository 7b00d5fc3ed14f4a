// SPDX-License-Identifier: MIT
//
// Gathers, bundles and indices for sk_as_cpp.hpp, after docs/language.md and without anything of the runtime's: arrays, and a loop
// over the domain. The macros give a kernel's parameters the values of sample_values.hpp; each does nothing if the reducer has removed
// the member that it is for.
#pragma once

#include "sample_values.hpp"

enum class Boundary { Clamp, Wrap, Mirror, Border };

inline int here[4], domain[4];  // the current index and the domain, x first

/// `i` modulo `n`, from 0 to n - 1.
inline long long modulo(long long i, long long n) { return (i % n + n) % n; }

template <class T>
inline constexpr bool isFloating = false;
template <>
inline constexpr bool isFloating<float> = true;

/// A float names the nearest element.
template <class I>
long long placeOf(I i) {
  if constexpr (isFloating<I>) {
    return static_cast<long long>(__builtin_floorf(i + 0.5f));
  } else {
    return static_cast<int>(i);
  }
}

template <class T, int N>
struct gather {
  T* elements = nullptr;
  int extents[4] = {1, 1, 1, 1};  // x first
  Boundary mode = Boundary::Clamp;
  T border = {};

  T at(const long long (&index)[4]) const {
    long long place = 0;
    for (int d = N - 1; d >= 0; --d) {
      const long long n = extents[d];
      long long i = index[d];
      if (i < 0 || i >= n) {
        if (mode == Boundary::Border) return border;
        if (mode == Boundary::Clamp) i = i < 0 ? 0 : n - 1;
        if (mode == Boundary::Wrap) i = modulo(i, n);
        if (mode == Boundary::Mirror) {
          i = modulo(i, 2 * n);
          if (i >= n) i = 2 * n - 1 - i;
        }
      }
      place = place * n + i;
    }
    return elements[place];
  }
  template <class I>
  auto operator[](I i) const;
};

/// A gather of which some slow dimensions have been chosen; `left` are not.
template <class T, int N, int left>
struct Slice {
  gather<T, N> whole;
  long long index[4] = {};

  template <class I>
  auto operator[](I i) const {
    Slice<T, N, left - 1> next{whole, {index[0], index[1], index[2], index[3]}};
    if constexpr (width_of<I> > 1) {
      static_assert(width_of<I> == left);
      for (int d = 0; d < left; ++d) next.index[d] = placeOf(i[d]);
      return whole.at(next.index);
    } else {
      next.index[left - 1] = placeOf(i);
      if constexpr (left == 1) {
        return whole.at(next.index);
      } else {
        return next;
      }
    }
  }
};
template <class T, int N>
template <class I>
auto gather<T, N>::operator[](I i) const {
  return Slice<T, N, N>{*this}[i];
}

/// In a domain of fewer dimensions than the gather, the current index is 0 in the others.
template <class T, int N>
T neighbor(const gather<T, N>& a, int dx, int dy = 0, int dz = 0, int dw = 0) {
  const long long offsets[4] = {dx, dy, dz, dw};
  long long index[4] = {};
  for (int d = 0; d < N; ++d) index[d] = here[d] + offsets[d];
  return a.at(index);
}
template <class T, int N, class V>
  requires(N > 1 && width_of<V> == N)
T neighbor(const gather<T, N>& a, V offset) {
  long long index[4] = {};
  for (int d = 0; d < N; ++d) index[d] = here[d] + static_cast<long long>(offset[d]);
  return a.at(index);
}

/// The elements around a position, each with its weight. Nothing rounds here.
template <class T, int N, class P>
T sample(const gather<T, N>& a, P position) {
  T sum = {};
  for (int corner = 0; corner < 1 << N; ++corner) {
    long long index[4] = {};
    float weight = 1;
    for (int d = 0; d < N; ++d) {
      float x;
      if constexpr (N == 1)
        x = position;
      else
        x = position[d];
      const float low = __builtin_floorf(x);
      const bool isUpper = (corner >> d & 1) != 0;
      index[d] = static_cast<long long>(low) + (isUpper ? 1 : 0);
      weight *= isUpper ? x - low : 1 - (x - low);
    }
    sum += a.at(index) * weight;
  }
  return sum;
}

template <int N>
struct IndexOf;
template <>
struct IndexOf<1> {
  using type = int;
};
template <>
struct IndexOf<2> {
  using type = int2;
};
template <>
struct IndexOf<3> {
  using type = int3;
};
template <>
struct IndexOf<4> {
  using type = int4;
};
template <int N>
using index = typename IndexOf<N>::type;

template <int N>
index<N> firstOf(const int (&numbers)[4]) {
  if constexpr (N == 1) {
    return numbers[0];
  } else {
    index<N> result;
    for (int d = 0; d < N; ++d) result[d] = numbers[d];
    return result;
  }
}
/// `index<N>(p, 0)`
template <int N, class... Parts>
index<N> make_index(Parts... parts) {
  if constexpr (N == 1) {
    return (parts, ...);
  } else {
    return make<index<N>>(parts...);
  }
}
template <int N>
index<N> axis(int d) {
  int numbers[4] = {};
  numbers[d] = 1;
  return firstOf<N>(numbers);
}
template <int N, class T>
index<N> indexof(const T&) {
  return firstOf<N>(here);
}
template <class T>
int4 indexof(const T&) {
  return firstOf<4>(here);
}
template <int N, class T, int rank>
index<N> extentof(const gather<T, rank>& a) {
  return firstOf<N>(a.extents);
}
template <class T, int rank>
int4 extentof(const gather<T, rank>& a) {
  return firstOf<4>(a.extents);
}
template <int N, class T>
index<N> extentof(const T&) {
  return firstOf<N>(domain);
}
template <class T>
int4 extentof(const T&) {
  return firstOf<4>(domain);
}

namespace bind {

using namespace fuzz::cpp;

inline void set(int& x, unsigned bits) { x = sampleInt(bits); }
inline void set(unsigned& x, unsigned bits) { x = sampleUint(bits); }
inline void set(float& x, unsigned bits) { x = sampleFloat(bits); }
inline void set(double& x, unsigned bits) { x = sampleDouble(bits); }
inline void set(bool& x, unsigned bits) { x = sampleBool(bits); }
/// The low bits of an integer of 8 or 16 bits. An enumeration is the integer that holds it.
template <class T>
void set(T& x, unsigned bits) {
  if constexpr (__is_enum(T)) {
    __underlying_type(T) number;
    set(number, bits);
    x = static_cast<T>(number);
  } else {
    x = static_cast<T>(static_cast<unsigned>(sampleInt(bits)));
  }
}

template <class T>
void leaf(T& x, Path path, int element) {
  if constexpr (width_of<T> == 1) {
    set(x, sampleBits(path, element, 0));
  } else {
    for (int c = 0; c < width_of<T>; ++c) {
      auto component = x[c];
      set(component, sampleBits(path, element, c));
      x[c] = component;
    }
  }
}

/// Gives a gather its extents and memory, one for each Tag.
template <class T, int N, class Tag>
void shape(gather<T, N>& a, Path path, Boundary mode, Tag) {
  static T memory[mostElements];
  a.elements = memory;
  a.mode = mode;
  for (int d = 0; d < N; ++d) a.extents[d] = gatherExtent(path, N, d);
}

inline void enter(int rank, int element) {
  for (int d = 0; d < 4; ++d) {
    domain[d] = domainExtents[rank - 1][d];
    here[d] = element % domain[d];
    element /= domain[d];
  }
}

}  // namespace bind

#define SK_IF(object, path, ...)             \
  [](auto& root) {                           \
    if constexpr (requires { root path; }) { \
      __VA_ARGS__;                           \
    }                                        \
  }(object);
#define SK_VALUE(object, path) SK_IF(object, path, bind::leaf(root path, #object #path, 0))
#define SK_GATHER(object, path, mode) \
  SK_IF(object, path, bind::shape(root path, #object #path, Boundary::mode, [] {}))
#define SK_LEAF(object, path, member)                                   \
  SK_IF(object, path.elements[0] member,                                \
        for (int i = 0; i < bind::elementsOf((root path).extents); ++i) \
            bind::leaf((root path).elements[i] member, #object #path #member, i))
#define SK_BORDER(object, path, ...) SK_IF(object, path, (root path).border = __VA_ARGS__)
/// Calls a kernel, which reads a[i] and writes r0[i], for each element of the domain of a rank.
#define SK_RUN(rank, ...)                                                       \
  for (int i = 0; i < bind::elementsOf(bind::domainExtents[(rank) - 1]); ++i) { \
    bind::enter(rank, i);                                                       \
    __VA_ARGS__;                                                                \
  }
#define SK_RUN_PARAMETERS const int *a, const uint *b, const float *c, int *r0, uint *r1, float *r2
