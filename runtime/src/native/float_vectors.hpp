// SPDX-License-Identifier: MIT
//
// Vectors of four doubles for the runtime's own sums. With vectors of eight floats, compilers convert each
// half by itself, which takes CPUs three times as long as converting vectors of four.
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

// Vectors are passed by reference, because compilers for other CPUs would warn about passing them by value.

SK_FOR_V3 inline void widen(const float* at, Doubles& wide) {
  using Floats [[gnu::vector_size(16)]] = float;
  Floats floats;
  std::memcpy(&floats, at, sizeof floats);
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  wide = __builtin_ia32_cvtps2pd256(floats);  // GCC 12 does not emit this for __builtin_convertvector
#else
  wide = __builtin_convertvector(floats, Doubles);
#endif
}

/// Rounds to floats.
SK_FOR_V3 inline void narrow(const Doubles& wide, float* to) {
  using Floats [[gnu::vector_size(16)]] = float;
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  const Floats floats = __builtin_ia32_cvtpd2ps256(wide);
#else
  const Floats floats = __builtin_convertvector(wide, Floats);
#endif
  std::memcpy(to, &floats, sizeof floats);
}

/// sum += x * y. The product is exact, so that there is one rounding, fused or not. Fused, it leaves the
/// adders free on CPUs that also use them to convert to double.
SK_FOR_V3 inline void addProduct(const Doubles& x, const Doubles& y, Doubles& sum) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  sum = __builtin_ia32_vfmaddpd256(x, y, sum);
#else
  sum += x * y;
#endif
}

}  // namespace sk
