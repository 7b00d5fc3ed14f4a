// SPDX-License-Identifier: MIT
//
// How much may be added to the digits of an exact sum before their carries must be propagated. Everything that adds digits
// takes its limits from here: the compiler (transforms/sum_exactly.cpp), the passes of devices with OpenGL, native code, and
// the sums of ranks.
//
// An exact sum is an integer in digits of 26 bits, lowest first, each of which is kept in a larger integer. Numbers are
// added digit by digit. Then the digits are longer than 26 bits, until they are *settled*: each digit but the last keeps
// its lowest 26 bits, and the rest is carried to the next.
#pragma once

#include <cassert>
#include <cstdint>

namespace sk::program {

inline constexpr int digitBits = 26;

/// How full the digits of a sum are: with load n, the magnitude of each is at most n (2^26 - 1). A term, which has up to
/// 26 bits in each digit, has load 1, and so have settled digits, which are 0 to 2^26 - 1. Loads of numbers that are added
/// add up. Zero has load 0.
///
/// Digits in integers of w bits can be settled if their load is at most N = 2^(w - 1 - 26), which is 32 for 32 bits. Proof:
/// let D = 2^26, and let c be the carry into a digit d, at first 0. If -N <= c <= N - 1, then
///   d + c <= N (D - 1) + N - 1 = N D - 1 = 2^(w - 1) - 1,   and   d + c >= -N (D - 1) - N = -N D = -2^(w - 1),
/// so that the integer holds d + c, and the next carry, which is (d + c) / D rounded down, is again in [-N, N - 1].
/// So no load may exceed N at any time. N + 1 is too much: 33 (2^26 - 1) > 2^31.
///
/// The last digit gets carries only, because terms end below it. It has the sign, and is never cut. Its unit is 2^286 units
/// of the sum, for products 2^598, and a term is less than 2^277, or 2^554. So it holds the carries of 2^39 terms.
template <class Integer>
class DigitLoad {
 public:
  static constexpr std::int64_t most = std::int64_t{1} << (8 * sizeof(Integer) - 1 - digitBits);

  constexpr DigitLoad() = default;  // of zero
  explicit constexpr DigitLoad(std::int64_t terms) : load_(terms) { assert(terms >= 0 && terms <= most); }

  static constexpr DigitLoad settled() { return DigitLoad(1); }
  /// The sum of two settled numbers, which combining leaves.
  static constexpr DigitLoad combined() { return settled() + settled(); }

  /// The number of terms whose digits add up to this load.
  constexpr std::int64_t terms() const { return load_; }
  /// The terms that can still be added.
  constexpr std::int64_t room() const { return most - load_; }
  friend constexpr DigitLoad operator+(DigitLoad a, DigitLoad b) { return DigitLoad(a.load_ + b.load_); }
  friend constexpr auto operator<=>(DigitLoad, DigitLoad) = default;

 private:
  std::int64_t load_ = 0;
};

}  // namespace sk::program
