// SPDX-License-Identifier: MIT
//
// Exact sums of floats, or of products of two, that lie side by side, in vectors: the same integers that exact.hpp's digits make of
// elements one by one. Of a block, each term is cut at the same bit, by adding and taking away a large number; what is above adds
// up in doubles without rounding, and so does what is below, cut once more (ExtractVector: Rump, Ogita and Oishi, Accurate
// floating-point summation, SIAM J. Sci. Comput. 31, 2008). What then still is left of a term is added by itself.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "sk/native/exact.hpp"
#include "sk/native/term_sums.hpp"

namespace sk::native {

/// Whether a kernel sums its term, sk_term(), without rounding.
template <class Fold>
concept SumsExactly = requires { requires Fold::sk_sumsExactly; };

/// An exact sum of terms of so many factors, 1 or 2.
template <int factors>
class ExactTerms {
 public:
  /// `count` terms more.
  template <class... Factors>
  void add(int count, const Factors*... x) {
    int first = 0;
    for (; count - first >= together; first += blockAt(count - first)) {
      addBlock(blockAt(count - first), (x + first)...);
    }
    for (; first < count; ++first) addOne(x[first]...);
  }

  /// Its settled digits and its flags, as the accumulators of a fold.
  template <class State>
  State state() const {
    std::int32_t settled[digitCount];
    std::int64_t carry = 0;
    for (int k = 0; k < digitCount; ++k) {
      const std::int64_t digit = digits_[k] + carry;
      carry = digit >> 26;
      settled[k] = static_cast<std::int32_t>(k + 1 == digitCount ? digit : digit & exact::digitMask);
    }
    State state{};
    std::size_t next = 0;
    visit(state, [&](Int& scalar) { scalar = next < digitCount ? settled[next++] : flags_; });
    return state;
  }

 private:
  static constexpr int digitCount = 12 * factors;
  static constexpr int unit = -149 * factors;  ///< the exponent of the integer's last bit
  static constexpr int together = 16;  ///< elements that go through the loops side by side
  static constexpr int most = 1024;  ///< elements of a block
  static constexpr int bitsOfMost = 10;

  static int blockAt(int left) { return std::min(left - left % together, most); }

  // ---- one by one --------------------------------------------------------------------------------

  void addOne(float x) {
    flags_ |= exactFlags(x).word();
    if (std::isfinite(x)) addWhole(x);
  }
  void addOne(float x, float y) {
    flags_ |= exactProductFlags(x, y).word();
    if (std::isfinite(x) && std::isfinite(y)) addWhole(double{x} * double{y});
  }

  /// A multiple of the unit.
  void addWhole(double x) {
    if (x == 0) return;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1} << 52;
    int at = static_cast<int>(bits >> 52 & 2047) - 1075 - unit;
    if (at < 0) {  // zeros
      mantissa >>= -at;
      at = 0;
    }
    const int shift = at % 26;
    const std::uint64_t rest = mantissa >> (26 - shift);
    const std::int64_t sign = x < 0 ? -1 : 1;
    std::int64_t* const digit = digits_ + at / 26;
    digit[0] += sign * static_cast<std::int64_t>(mantissa << shift & exact::digitMask);
    digit[1] += sign * static_cast<std::int64_t>(rest & exact::digitMask);
    digit[2] += sign * static_cast<std::int64_t>(rest >> 26);
  }

  // ---- blocks ------------------------------------------------------------------------------------

  /// The largest magnitude, as bits: beyond those of infinity where there is a NaN.
  SK_NATIVE_VECTORS static std::uint32_t largestOf(const float* x, int count) {
    std::uint32_t largest = 0;
    for (int i = 0; i < count; ++i)
      largest = std::max(largest, std::bit_cast<std::uint32_t>(x[i]) & 0x7fffffff);
    return largest;
  }

  /// What adding this and taking it away again cuts numbers below 2^exponent at, so that the upper parts of a block add up exactly.
  static double cutterFor(int exponent) { return std::ldexp(1.5, exponent + bitsOfMost); }
  /// Below which power of 2 the lower parts then are.
  static int below(int exponent) { return exponent + bitsOfMost - 52; }

  template <class... Factors>
  void addBlock(int count, const Factors*... x) {
    const std::uint32_t largest[] = {largestOf(x, count)...};
    int exponent = 0;  // all terms are below this power of 2
    bool isPlain = true;
    for (const std::uint32_t bits : largest) {
      isPlain = isPlain && bits != 0 && bits < 0x7f800000;
      exponent += std::max(static_cast<int>(bits >> 23), 1) - 126;
    }
    if (!isPlain) {
      for (int i = 0; i < count; ++i) addOne(x[i]...);
      return;
    }
    flags_ |= 1;
    const double upper = cutterFor(exponent);
    const double lower = cutterFor(below(exponent));
    double sums[2];
    if (!addParts(count, upper, lower, sums, x...)) {
      for (int i = 0; i < count; ++i) addWhole(restOf(upper, lower, x[i]...));
    }
    for (const double sum : sums) addWhole(sum);
  }

  static double cut(double x, double cutter) { return (x + cutter) - cutter; }
  template <class... Floats>
  static double restOf(double upper, double lower, Floats... x) {
    const double term = (double{x} * ...);
    const double rest = term - cut(term, upper);
    return rest - cut(rest, lower);
  }

  SK_NATIVE_VECTORS static void termsAt(int i, Doubles& terms, const float* x) { widen(x + i, terms); }
  SK_NATIVE_VECTORS static void termsAt(int i, Doubles& terms, const float* x, const float* y) {
    Doubles others;
    widen(x + i, terms);
    widen(y + i, others);
    terms *= others;
  }

  /// Adds up both parts of each term; false if there is more than these.
  template <class... Factors>
  SK_NATIVE_VECTORS static bool addParts(int count, double upper, double lower, double (&sums)[2],
                                         const Factors*... x) {
    constexpr int vectors = together / doublesOfVector;
    const Doubles one{upper, upper, upper, upper};
    const Doubles two{lower, lower, lower, lower};
    Doubles highs[vectors] = {};
    Doubles lows[vectors] = {};
    Words left[vectors] = {};
    for (int i = 0; i < count; i += together) {
#pragma GCC unroll 4
      for (int v = 0; v < vectors; ++v) {
        Doubles term;
        termsAt(i + v * doublesOfVector, term, x...);
        const Doubles high = (term + one) - one;
        const Doubles rest = term - high;
        const Doubles low = (rest + two) - two;
        highs[v] += high;
        lows[v] += low;
        left[v] |= (Words)(rest - low);
      }
    }
    sums[0] = sums[1] = 0;
    std::int64_t all = 0;
    for (int v = 0; v < vectors; ++v) {
      for (int k = 0; k < doublesOfVector; ++k) {
        sums[0] += highs[v][k];
        sums[1] += lows[v][k];
        all |= left[v][k];
      }
    }
    return all == 0;
  }

  using Words [[gnu::vector_size(32)]] = std::int64_t;

  std::int64_t digits_[digitCount] = {};  ///< not settled: 2^36 terms have room
  std::int32_t flags_ = 0;
};

}  // namespace sk::native
