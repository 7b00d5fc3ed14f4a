// SPDX-License-Identifier: MIT
#include "native/scan_floats.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "native/float_vectors.hpp"

namespace sk {

namespace {

using native::Chunk;
using native::Frame;

constexpr std::int64_t scannedTogether = 2 * doublesPerVector;

/// The sum of each element and those before it. -0 changes no sum.
[[gnu::always_inline]] inline void sumsOf(Doubles& x) {
  constexpr Doubles nothing{-0.0, -0.0, -0.0, -0.0};
  x += __builtin_shufflevector(x, nothing, 4, 0, 1, 2);
  x += __builtin_shufflevector(x, nothing, 4, 5, 0, 1);
}

/// Scans eight terms from `carry` on, which becomes the sum of all. In an exclusive scan, the sums are those before each.
template <bool isExclusive>
[[gnu::always_inline]] inline void scanEight(Doubles& first, Doubles& second, Doubles& carry) {
  sumsOf(first);
  sumsOf(second);
  second += __builtin_shufflevector(first, first, 3, 3, 3, 3);
  const Doubles before = carry;
  carry += __builtin_shufflevector(second, second, 3, 3, 3, 3);
  first += before;
  second += before;
  if constexpr (isExclusive) {
    second = __builtin_shufflevector(first, second, 3, 4, 5, 6);
    first = __builtin_shufflevector(before, first, 3, 4, 5, 6);
  }
}

/// How CPUs with 256-bit vectors read terms and store sums.
struct WideVectors {
  SK_FOR_V3 static void read(Doubles& terms, std::int64_t i, const float* x) { widen(x + i, terms); }
  SK_FOR_V3 static void read(Doubles& terms, std::int64_t i, const float* x, const float* y) {
    Doubles other;
    widen(x + i, terms);
    widen(y + i, other);
    terms *= other;
  }
  SK_FOR_V3 static void store(const Doubles& sums, double* to) { std::memcpy(to, &sums, sizeof sums); }
  SK_FOR_V3 static void store(const Doubles& sums, float* to) { narrow(sums, to); }
};

/// How others do.
struct AnyVectors {
  template <class... Factors>
  static void read(Doubles& terms, std::int64_t i, const Factors*... factors) {
    for (int lane = 0; lane < doublesPerVector; ++lane) terms[lane] = (double{factors[i + lane]} * ...);
  }
  template <class Result>
  static void store(const Doubles& sums, Result* to) {
    for (int lane = 0; lane < doublesPerVector; ++lane) to[lane] = static_cast<Result>(sums[lane]);
  }
};

/// The last terms, fewer than eight, and -0 behind them.
template <class... Factors>
[[gnu::always_inline]] inline void readLast(double* terms, std::int64_t i, std::int64_t count,
                                            const Factors*... factors) {
  std::fill_n(terms, scannedTogether, -0.0);
  for (std::int64_t k = 0; i + k < count; ++k) terms[k] = (double{factors[i + k]} * ...);
}

/// All terms are read before the sums of their places are stored, which may be in the same array.
template <class Vectors, bool isExclusive, class Result, class... Factors>
[[gnu::always_inline]] inline double scanAll(double start, std::int64_t count, Result* results,
                                             const Factors*... factors) {
  Doubles carry{start, start, start, start}, first, second;
  std::int64_t i = 0;
  for (; i + scannedTogether <= count; i += scannedTogether) {
    Vectors::read(first, i, factors...);
    Vectors::read(second, i + doublesPerVector, factors...);
    scanEight<isExclusive>(first, second, carry);
    Vectors::store(first, results + i);
    Vectors::store(second, results + i + doublesPerVector);
  }
  if (i < count) {
    double terms[scannedTogether];
    Result sums[scannedTogether];
    readLast(terms, i, count, factors...);
    std::memcpy(&first, terms, sizeof first);
    std::memcpy(&second, terms + doublesPerVector, sizeof second);
    scanEight<isExclusive>(first, second, carry);
    AnyVectors::store(first, sums);
    AnyVectors::store(second, sums + doublesPerVector);
    std::copy_n(sums, count - i, results + i);
  }
  return carry[0];
}

template <bool isExclusive, class Result, class... Factors>
SK_FOR_V3 double scanWide(double start, std::int64_t count, Result* results, const Factors*... factors) {
  return scanAll<WideVectors, isExclusive>(start, count, results, factors...);
}
template <bool isExclusive, class Result, class... Factors>
double scanAny(double start, std::int64_t count, Result* results, const Factors*... factors) {
  return scanAll<AnyVectors, isExclusive>(start, count, results, factors...);
}

template <bool isWide, class Result, class... Factors>
double scan(double start, bool isExclusive, std::int64_t count, Result* results, const Factors*... factors) {
  if constexpr (isWide) {
    return isExclusive ? scanWide<true>(start, count, results, factors...)
                       : scanWide<false>(start, count, results, factors...);
  } else {
    return isExclusive ? scanAny<true>(start, count, results, factors...)
                       : scanAny<false>(start, count, results, factors...);
  }
}

template <std::size_t factors, class Result, bool isWide>
void scanTerms(const Frame* frame, const Chunk* chunk, void* const* state, void* const* results,
               std::int64_t starts, std::int64_t isExclusive) {
  const auto& sums = *static_cast<const SumFrame*>(frame);
  double& carry = *static_cast<double*>(state[0]);
  auto* const to = static_cast<Result*>(results[0]);
  const auto* const x = static_cast<const float*>(chunk->arrays[0]);
  const double start = starts != 0 ? sums.start : carry;
  if constexpr (factors == 1) {
    carry = scan<isWide>(start, isExclusive != 0, chunk->count, to, x);
  } else {
    const auto* const y = static_cast<const float*>(chunk->arrays[1]);
    carry = scan<isWide>(start, isExclusive != 0, chunk->count, to, x, y);
  }
  if (starts != 0 && isExclusive != 0) to[0] = static_cast<Result>(sums.identity);
}

template <class Result, bool isWide>
native::ScanFunction* scanOf(std::size_t factors) {
  return factors == 1 ? &scanTerms<1, Result, isWide> : &scanTerms<2, Result, isWide>;
}

}  // namespace

native::ScanFunction* floatScan(std::size_t factors, bool storesFloats, bool isWide) {
  if (isWide) return storesFloats ? scanOf<float, true>(factors) : scanOf<double, true>(factors);
  return storesFloats ? scanOf<float, false>(factors) : scanOf<double, false>(factors);
}

void storeIdentity(const Frame* frame, void* const* values) {
  *static_cast<double*>(values[0]) = static_cast<const SumFrame*>(frame)->identity;
}

}  // namespace sk
