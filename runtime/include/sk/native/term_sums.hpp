// SPDX-License-Identifier: MIT
//
// Sums of floats, or of products of two, in doubles: what fold.hpp's loops come to where a kernel does nothing else, in the same
// order. Written down in vectors, since compilers load eight floats to convert the halves of them, for which CPUs take three times
// as long as for fours.
#pragma once

#include <cstring>
#include <tuple>

#include "sk/native/hot.hpp"

namespace sk::native {

/// Whether a kernel reads floats and sums them in doubles.
template <class Fold>
concept SumsTerm = requires(Fold fold) {
  requires Fold::sk_readsFloats;
  fold.sk_term();
};

using Doubles [[gnu::vector_size(32)]] = double;
inline constexpr int doublesOfVector = 4;

/// For functions that are part of what is marked SK_NATIVE_WIDE alone: what they do with vectors is then said in its instructions.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define SK_NATIVE_VECTORS [[gnu::target("avx2,fma")]]
#else
#define SK_NATIVE_VECTORS
#endif

// No vector is handed over by value, of which compilers for other CPUs would warn.

SK_NATIVE_VECTORS inline void widen(const float* at, Doubles& wide) {
  using Floats [[gnu::vector_size(16)]] = float;
  Floats floats;
  std::memcpy(&floats, at, sizeof floats);
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  wide = __builtin_ia32_cvtps2pd256(floats);  // which GCC 12 makes of no __builtin_convertvector
#else
  wide = __builtin_convertvector(floats, Doubles);
#endif
}

/// sum += x * y, where the product is exact. In one operation it takes the place of additions on CPUs that convert to doubles where
/// they add.
SK_NATIVE_VECTORS inline void addProduct(const Doubles& x, const Doubles& y, Doubles& sum) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  sum = __builtin_ia32_vfmaddpd256(x, y, sum);
#else
  for (int k = 0; k < doublesOfVector; ++k) sum[k] = __builtin_fma(x[k], y[k], sum[k]);
#endif
}

SK_NATIVE_VECTORS inline void addTerm(Doubles& sum, int element, const float* x) {
  Doubles wide;
  widen(x + element, wide);
  addProduct(wide, Doubles{1, 1, 1, 1}, sum);
}
SK_NATIVE_VECTORS inline void addTerm(Doubles& sum, int element, const float* x, const float* y) {
  Doubles first, second;
  widen(x + element, first);
  widen(y + element, second);
  addProduct(first, second, sum);
}

/// Elements that are fetched before they are needed: converting them takes so many operations that few loads are under way at once.
inline constexpr int fetchedAhead = 384;

/// Adds `rounds` times `side` terms to so many columns, which begin at `start`, or with the first terms where that is -0.
template <int side, class... Factors>
void sumTerms(double* columns, double start, int rounds, const Factors*... factors) {
  constexpr int vectors = side / doublesOfVector;
  Doubles sums[vectors];
#pragma GCC unroll 16
  for (Doubles& sum : sums) sum = Doubles{start, start, start, start};
  for (int round = 0; round < rounds; ++round) {
    const int first = round * side;
    for (int ahead = 0; ahead < side; ahead += 16) {
      (__builtin_prefetch(factors + first + ahead + fetchedAhead), ...);
    }
#pragma GCC unroll 16
    for (int v = 0; v < vectors; ++v) addTerm(sums[v], first + v * doublesOfVector, factors...);
  }
  std::memcpy(columns, sums, sizeof sums);
}

}  // namespace sk::native
