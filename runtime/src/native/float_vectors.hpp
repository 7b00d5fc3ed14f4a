// SPDX-License-Identifier: MIT
//
// Vectors of four doubles, which the runtime's own sums compute with. Compilers that are shown eight floats convert the halves of
// them, for which CPUs take three times as long as for fours.
#pragma once

#include <cstdint>
#include <cstring>

/// Marks functions that are called only on CPUs of x86-64-v3 (levelOfCpu()).
#if defined(__x86_64__) && defined(__GNUC__)
#define SK_FOR_V3 [[gnu::target("arch=x86-64-v3")]]
#else
#define SK_FOR_V3
#endif

namespace sk {

using Doubles [[gnu::vector_size(32)]] = double;
using Words [[gnu::vector_size(32)]] = std::int64_t;
inline constexpr int doublesPerVector = 4;

// No vector is handed over by value, of which compilers for other CPUs would warn.

SK_FOR_V3 inline void widen(const float* at, Doubles& wide) {
  using Floats [[gnu::vector_size(16)]] = float;
  Floats floats;
  std::memcpy(&floats, at, sizeof floats);
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  wide = __builtin_ia32_cvtps2pd256(floats);  // which GCC 12 makes of no __builtin_convertvector
#else
  wide = __builtin_convertvector(floats, Doubles);
#endif
}

/// sum += x * y, where the product is exact, so that it is rounded once in any case. In one operation it takes the place of additions
/// on CPUs that convert to doubles where they add.
SK_FOR_V3 inline void addProduct(const Doubles& x, const Doubles& y, Doubles& sum) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  sum = __builtin_ia32_vfmaddpd256(x, y, sum);
#else
  sum += x * y;
#endif
}

}  // namespace sk
