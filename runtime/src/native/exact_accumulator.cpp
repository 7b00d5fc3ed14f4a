// SPDX-License-Identifier: MIT
//
// Splits each term of a block at the same bit, by adding and subtracting a large number. The upper parts add
// up in doubles without rounding, and so do the lower parts, which are split once more (ExtractVector: Rump,
// Ogita and Oishi, Accurate floating-point summation, SIAM J. Sci. Comput. 31, 2008). What then remains of a
// term is added to the digits by itself.
#include "native/exact_accumulator.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "native/entries.hpp"
#include "native/float_vectors.hpp"
#include "support/rounds_as_written.hpp"

namespace sk {

namespace {

using program::digitBits;
constexpr std::int64_t digitMask = (std::int64_t{1} << digitBits) - 1;
constexpr std::uint32_t infinityBits = 0x7f800000;

constexpr int together = 16;  ///< terms that the loops process together
constexpr int mostInBlock = 1024;
constexpr int bitsOfMost = 10;

int blockAt(std::int64_t left) {
  return static_cast<int>(std::min<std::int64_t>(left - left % together, mostInBlock));
}

bool hasVectors() {
#if defined(__x86_64__)
  return levelOfCpu() >= native::Level::V3;
#else
  return true;
#endif
}

std::uint32_t magnitudeOf(float x) { return std::bit_cast<std::uint32_t>(x) & 0x7fffffff; }

/// The largest magnitude as bits, which exceed those of infinity if there is a NaN.
SK_FOR_V3 std::uint32_t largestOf(const float* x, int count) {
  std::uint32_t largest = 0;
  for (int i = 0; i < count; ++i) {
    largest = std::max(largest, std::bit_cast<std::uint32_t>(x[i]) & 0x7fffffff);
  }
  return largest;
}

/// Whether a finite term is -0.
bool isNegativeZero(float x) { return x == 0 && std::signbit(x); }
bool isNegativeZero(float x, float y) { return (x == 0 || y == 0) && std::signbit(x) != std::signbit(y); }

/// The number whose addition and subtraction splits numbers below 2^exponent, so that the upper parts of a
/// block add up exactly.
double cutterFor(int exponent) { return std::ldexp(1.5, exponent + bitsOfMost); }
/// The lower parts are then below 2 to the power of this.
int below(int exponent) { return exponent + bitsOfMost - 52; }

double cut(double x, double cutter) { return (x + cutter) - cutter; }
template <class... Floats>
double restOf(double upper, double lower, Floats... x) {
  const double term = (double{x} * ...);
  const double rest = term - cut(term, upper);
  return rest - cut(rest, lower);
}

SK_FOR_V3 void termsAt(int i, Doubles& terms, const float* x) { widen(x + i, terms); }
SK_FOR_V3 void termsAt(int i, Doubles& terms, const float* x, const float* y) {
  Doubles others;
  widen(x + i, terms);
  widen(y + i, others);
  terms *= others;
}

/// Adds up both parts of each term; returns false if anything remains of a term.
template <class... Factors>
SK_FOR_V3 bool addParts(int count, double upper, double lower, double (&sums)[2], const Factors*... x) {
  constexpr int vectors = together / doublesPerVector;
  const Doubles one{upper, upper, upper, upper};
  const Doubles two{lower, lower, lower, lower};
  Doubles highs[vectors] = {};
  Doubles lows[vectors] = {};
  Words left[vectors] = {};
  for (int i = 0; i < count; i += together) {
#pragma GCC unroll 4
    for (int v = 0; v < vectors; ++v) {
      Doubles term;
      termsAt(i + v * doublesPerVector, term, x...);
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
    for (int k = 0; k < doublesPerVector; ++k) {
      sums[0] += highs[v][k];
      sums[1] += lows[v][k];
      all |= left[v][k];
    }
  }
  return all == 0;
}

/// The float nearest to an integer, whose bit `base` represents 2^-149. Its digits must be settled and not
/// negative.
float nearestFloat(const std::int64_t* digits, int count, bool isNegative, int base) {
  const auto digit = [&](int k) { return k < 0 ? std::uint64_t{0} : static_cast<std::uint64_t>(digits[k]); };
  int top = count - 1;
  while (top >= 0 && digits[top] == 0) --top;
  if (top < 0) return 0;
  const std::uint64_t last = digit(top) << digitBits | digit(top - 1);
  const int width = std::bit_width(last);
  const int first = digitBits * (top - 1);  // the integer's bit that is the lowest of `last`
  const int unit = std::max(first + width - 24, base);
  const int shift = std::min(unit - first, 54);
  auto mantissa = static_cast<std::uint32_t>(last >> shift);
  bool isMore = (last & ((std::uint64_t{1} << (shift - 1)) - 1)) != 0;
  for (int k = 0; k < top - 1; ++k) isMore = isMore || digits[k] != 0;
  const bool isHalf = (last >> (shift - 1) & 1) != 0;
  if (isHalf && (isMore || (mantissa & 1) != 0)) ++mantissa;
  const std::uint32_t bits = (static_cast<std::uint32_t>(std::min(unit - base, 254)) << 23) + mantissa;
  return std::bit_cast<float>(std::min(bits, infinityBits) | (isNegative ? 0x80000000U : 0U));
}

/// Reduces all digits but the last to 26 bits, with the same sum.
void settle(std::int64_t* digits, int count) {
  for (int k = 0; k + 1 < count; ++k) {
    digits[k + 1] += digits[k] >> digitBits;
    digits[k] &= digitMask;
  }
}

}  // namespace

void ExactAccumulator::add(std::int64_t count, const float* x) {
  if (digitCount_ == mostDigits) {
    static constexpr float one = 1;
    for (std::int64_t i = 0; i < count; ++i) addAll(1, x + i, &one);
  } else {
    addAll(count, x);
  }
}

void ExactAccumulator::add(std::int64_t count, const float* x, const float* y) { addAll(count, x, y); }

void ExactAccumulator::reserve(Load load) {
  if (load_.room() < load.terms()) {
    settle(digits_, digitCount_);
    load_ = Load::settled();
  }
  load_ = load_ + load;
}

void ExactAccumulator::add(const ExactAccumulator& other) {
  if (other.load_ > Load(Load::most / 2)) {
    ExactAccumulator settled = other;
    settle(settled.digits_, digitCount_);
    settled.load_ = Load::settled();
    return add(settled);
  }
  reserve(other.load_);
  for (int k = 0; k < digitCount_; ++k) digits_[k] += other.digits_[k];
  flags_ |= other.flags_;
}

template <class... Factors>
void ExactAccumulator::addAll(std::int64_t count, const Factors*... x) {
  std::int64_t first = 0;
  if (hasVectors()) {
    for (; count - first >= together; first += blockAt(count - first)) {
      addBlock(blockAt(count - first), (x + first)...);
    }
  }
  reserve(Load(count - first));
  for (; first < count; ++first) addOne(x[first]...);
}

template <class... Factors>
void ExactAccumulator::addBlock(int count, const Factors*... x) {
  reserve(Load(count + 2));  // what remains of each term, and both sums
  const std::uint32_t largest[] = {largestOf(x, count)...};
  int exponent = 0;  // all terms are below this power of 2
  bool isPlain = true;
  for (const std::uint32_t bits : largest) {
    isPlain = isPlain && bits != 0 && bits < infinityBits;
    exponent += std::max(static_cast<int>(bits >> 23), 1) - 126;
  }
  if (!isPlain) {
    for (int i = 0; i < count; ++i) addOne(x[i]...);
    return;
  }
  for (int i = 0; (flags_ & HasOther) == 0 && i < count; ++i) {
    if (!isNegativeZero(x[i]...)) flags_ |= HasOther;
  }
  const double upper = cutterFor(exponent);
  const double lower = cutterFor(below(exponent));
  double sums[2];
  if (!addParts(count, upper, lower, sums, x...)) {
    for (int i = 0; i < count; ++i) addWhole(restOf(upper, lower, x[i]...));
  }
  for (const double sum : sums) addWhole(sum);
}

void ExactAccumulator::addOne(float x) {
  const std::uint32_t magnitude = magnitudeOf(x);
  if (magnitude > infinityBits) {
    flags_ |= HasNaN;
  } else if (magnitude == infinityBits) {
    flags_ |= std::signbit(x) ? HasNegativeInfinity : HasInfinity;
  } else {
    flags_ |= isNegativeZero(x) ? 0U : HasOther;
    addWhole(x);
  }
}

void ExactAccumulator::addOne(float x, float y) {
  const std::uint32_t low = std::min(magnitudeOf(x), magnitudeOf(y));
  const std::uint32_t high = std::max(magnitudeOf(x), magnitudeOf(y));
  const bool isNegative = std::signbit(x) != std::signbit(y);
  if (high > infinityBits || (high == infinityBits && low == 0)) {
    flags_ |= HasNaN;
  } else if (high == infinityBits) {
    flags_ |= isNegative ? HasNegativeInfinity : HasInfinity;
  } else {
    flags_ |= isNegativeZero(x, y) ? 0U : HasOther;
    addWhole(double{x} * double{y});
  }
}

/// Adds a multiple of the unit.
void ExactAccumulator::addWhole(double x) {
  if (x == 0) return;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1} << 52;
  int at = static_cast<int>(bits >> 52 & 2047) - 1075 - unit();
  if (at < 0) {  // the lowest bits are zeros
    mantissa >>= -at;
    at = 0;
  }
  const int shift = at % digitBits;
  const std::uint64_t rest = mantissa >> (digitBits - shift);
  const std::int64_t sign = x < 0 ? -1 : 1;
  std::int64_t* const digit = digits_ + at / digitBits;
  digit[0] += sign * (static_cast<std::int64_t>(mantissa << shift) & digitMask);
  digit[1] += sign * (static_cast<std::int64_t>(rest) & digitMask);
  digit[2] += sign * static_cast<std::int64_t>(rest >> digitBits);
}

std::vector<std::int64_t> ExactAccumulator::words() const {
  std::vector<std::int64_t> words(digits_, digits_ + digitCount_);
  settle(words.data(), digitCount_);
  for (std::uint32_t flag = 1; flag <= HasNaN; flag *= 2) words.push_back((flags_ & flag) != 0 ? 1 : 0);
  return words;
}

ExactAccumulator ExactAccumulator::ofWords(std::span<const std::int64_t> words) {
  const std::size_t digits = words.size() - 4;
  ExactAccumulator sum(digits == mostDigits ? Of::Products : Of::Floats);
  std::copy_n(words.begin(), digits, sum.digits_);
  sum.load_ = Load(Load::most);
  for (std::size_t k = 0; k < 4; ++k) sum.flags_ |= words[digits + k] != 0 ? 1U << k : 0U;
  return sum;
}

float ExactAccumulator::rounded() const {
  constexpr std::uint32_t both = HasInfinity | HasNegativeInfinity;
  if ((flags_ & HasNaN) != 0 || (flags_ & both) == both) return std::numeric_limits<float>::quiet_NaN();
  if ((flags_ & both) != 0) {
    const float infinity = std::numeric_limits<float>::infinity();
    return (flags_ & HasInfinity) != 0 ? infinity : -infinity;
  }
  if ((flags_ & HasOther) == 0) return -0.0F;
  std::int64_t digits[mostDigits];
  std::copy_n(digits_, digitCount_, digits);
  settle(digits, digitCount_);
  const bool isNegative = digits[digitCount_ - 1] < 0;
  if (isNegative) {
    for (int k = 0; k < digitCount_; ++k) digits[k] = -digits[k];
    settle(digits, digitCount_);
  }
  return nearestFloat(digits, digitCount_, isNegative, -149 - unit());
}

namespace {

using native::Quad;
__extension__ typedef unsigned __int128 Bits128;

constexpr int wordBits = 32;
constexpr std::int64_t wordMask = (std::int64_t{1} << wordBits) - 1;
std::int64_t lowestDigit(Bits128 number) { return static_cast<std::uint32_t>(number); }
/// The digits that a term reaches with its 113 bits, and those for the carries of many terms.
constexpr int digitsOfTerm = 5, digitsOfCarry = 2;
constexpr std::int64_t mostUnsettled = std::int64_t{1} << 30;
/// Bit 0 of digit 0 represents 2^leastPower, the least __float128.
constexpr int leastPower = -16494;

static_assert(sizeof(Quad) == sizeof(Bits128), "IEEE 754's binary128 is what sums of doubles are made in");

/// IEEE 754's formats. Bit `least` of the accumulator represents the least number.
struct DoubleFormat {
  using Bits = std::uint64_t;
  static constexpr int mantissaBits = 52, least = -1074 - leastPower;
  static constexpr Bits infinity = std::uint64_t{0x7ff} << mantissaBits;
};
struct QuadFormat {
  using Bits = Bits128;
  static constexpr int mantissaBits = 112, least = 0;
  static constexpr Bits infinity = Bits128{0x7fff} << mantissaBits;
};
template <class Format>
constexpr typename Format::Bits nan =
    Format::infinity | typename Format::Bits{1} << (Format::mantissaBits - 1);
template <class Format>
constexpr typename Format::Bits signBit = typename Format::Bits{1} << (8 * sizeof(typename Format::Bits) - 1);

Bits128 bitsOf(Quad x) {
  Bits128 bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// The upper 56 of a number's 113 bits, so that products of two halves are exact (Dekker, A floating-point
/// technique for extending the available precision, Numerische Mathematik 18, 1971). The number must be below
/// 2^16326.
Quad upperHalf(Quad x) {
  constexpr auto splitter = static_cast<Quad>((std::int64_t{1} << 57) + 1);
  const Quad spread = x * splitter;
  return spread - (spread - x);
}

/// The rounding error of a finite product.
Quad lostBy(Quad product, Quad x, Quad y) {
  const Quad upperX = upperHalf(x), upperY = upperHalf(y);
  const Quad lowerX = x - upperX, lowerY = y - upperY;
  return ((upperX * upperY - product) + upperX * lowerY + lowerX * upperY) + lowerX * lowerY;
}

}  // namespace

void WideAccumulator::reach(int first, int end) {
  if (digits_.empty()) first_ = first;
  if (first < first_) {
    digits_.insert(digits_.begin(), static_cast<std::size_t>(first_ - first), 0);
    first_ = first;
  }
  const auto size = static_cast<std::size_t>(end - first_);
  if (digits_.size() < size) digits_.resize(size);
}

void WideAccumulator::addTerm(Quad x) {
  const Bits128 bits = bitsOf(x);
  const Bits128 magnitude = bits & ~signBit<QuadFormat>;
  const bool isNegative = magnitude != bits;
  if (magnitude >= QuadFormat::infinity) {
    flags_ |= magnitude > QuadFormat::infinity ? HasNaN : isNegative ? HasNegativeInfinity : HasInfinity;
    return;
  }
  flags_ |= magnitude == 0 && isNegative ? 0U : HasOther;
  if (magnitude == 0) return;
  const int exponent = static_cast<int>(magnitude >> QuadFormat::mantissaBits);
  Bits128 mantissa = magnitude & ((Bits128{1} << QuadFormat::mantissaBits) - 1);
  if (exponent > 0) mantissa |= Bits128{1} << QuadFormat::mantissaBits;
  const int at = std::max(exponent - 1, 0);  // the bit of the accumulator for the lowest bit of the mantissa
  reach(at / wordBits, at / wordBits + digitsOfTerm + digitsOfCarry);
  std::int64_t* digit = digits_.data() + (at / wordBits - first_);
  const int shift = at % wordBits;
  const std::int64_t sign = isNegative ? -1 : 1;
  *digit++ += sign * lowestDigit(mantissa << shift);
  for (mantissa >>= wordBits - shift; mantissa != 0; mantissa >>= wordBits) {
    *digit++ += sign * lowestDigit(mantissa);
  }
  if (++unsettled_ >= mostUnsettled) settle();
}

void WideAccumulator::add(const WideAccumulator& other) {
  flags_ |= other.flags_;
  if (other.digits_.empty()) return;
  if (unsettled_ + other.unsettled_ >= mostUnsettled) settle();
  reach(other.first_, other.first_ + static_cast<int>(other.digits_.size()) + 1);
  for (std::size_t k = 0; k < other.digits_.size(); ++k) {
    digits_[k + static_cast<std::size_t>(other.first_ - first_)] += other.digits_[k];
  }
  unsettled_ += other.unsettled_ + 1;
}

/// Reduces all digits but the last to 32 bits, with the same sum.
void WideAccumulator::settle() {
  for (std::size_t k = 0; k + 1 < digits_.size(); ++k) {
    digits_[k + 1] += digits_[k] >> wordBits;
    digits_[k] &= wordMask;
  }
  unsettled_ = 0;
}

void WideAccumulator::negate() {
  for (std::int64_t& digit : digits_) digit = -digit;
  settle();
}

template <class Format>
typename Format::Bits WideAccumulator::nearest() const {
  using Bits = typename Format::Bits;
  constexpr std::uint32_t both = HasInfinity | HasNegativeInfinity;
  if ((flags_ & HasNaN) != 0 || (flags_ & both) == both) return nan<Format>;
  if ((flags_ & both) != 0) {
    return Format::infinity | ((flags_ & HasInfinity) != 0 ? Bits{0} : signBit<Format>);
  }
  if ((flags_ & HasOther) == 0) return signBit<Format>;
  WideAccumulator sum = *this;
  sum.settle();
  const bool isNegative = !sum.digits_.empty() && sum.digits_.back() < 0;
  if (isNegative) sum.negate();
  const auto& digits = sum.digits_;
  auto top = static_cast<int>(digits.size()) - 1;
  while (top >= 0 && digits[static_cast<std::size_t>(top)] == 0) --top;
  if (top < 0) return 0;
  const auto digit = [&](int number) {  // by its number in the accumulator
    const int k = number - sum.first_;
    return k < 0 || k > top ? std::uint64_t{0}
                            : static_cast<std::uint64_t>(digits[static_cast<std::size_t>(k)]);
  };
  const auto bit = [&](int number) {
    return number >= 0 && (digit(number / wordBits) >> number % wordBits & 1) != 0;
  };
  const int highest = (sum.first_ + top) * wordBits + std::bit_width(digit(sum.first_ + top)) - 1;
  const int lowest = std::max(highest - Format::mantissaBits, Format::least);  // the lowest bit to keep
  Bits mantissa = 0;
  for (int number = highest; number >= lowest; --number) mantissa = mantissa << 1 | (bit(number) ? 1U : 0U);
  bool isMore = false;
  for (int number = sum.first_ * wordBits; number < lowest - 1 && !isMore; ++number) isMore = bit(number);
  if (bit(lowest - 1) && (isMore || (mantissa & 1) != 0)) ++mantissa;
  // the mantissa's leading bit adds 1 to the exponent; subnormal numbers do not have it
  const Bits bits = (static_cast<Bits>(lowest - Format::least) << Format::mantissaBits) + mantissa;
  constexpr int exponents = static_cast<int>(Format::infinity >> Format::mantissaBits);
  const bool isTooLarge = lowest - Format::least >= exponents;
  return (isTooLarge ? Format::infinity : std::min(bits, Format::infinity)) |
         (isNegative ? signBit<Format> : Bits{0});
}

double WideAccumulator::nearestDouble() const { return std::bit_cast<double>(nearest<DoubleFormat>()); }

Quad WideAccumulator::nearestQuad() const {
  const Bits128 bits = nearest<QuadFormat>();
  Quad number = 0;
  std::memcpy(&number, &bits, sizeof number);
  return number;
}

template <class Real>
void WideSum<Real>::add(std::int64_t count, const Real* x) {
  for (std::int64_t i = 0; i < count; ++i) addTerm(x[i]);
}

template <class Real>
void WideSum<Real>::add(std::int64_t count, const Real* x, const Real* y) {
  for (std::int64_t i = 0; i < count; ++i) {
    const Quad product = Quad{x[i]} * Quad{y[i]};
    addTerm(product);
    if constexpr (sizeof(Real) == sizeof(Quad)) {
      const bool isFinite = (bitsOf(product) & ~signBit<QuadFormat>) < QuadFormat::infinity;
      if (isFinite && product != 0) addTerm(lostBy(product, x[i], y[i]));
    }
  }
}

template <class Real>
Real WideSum<Real>::rounded() const {
  if constexpr (sizeof(Real) == sizeof(double)) {
    return nearestDouble();
  } else {
    return nearestQuad();
  }
}

template class WideSum<double>;
template class WideSum<Quad>;

}  // namespace sk
