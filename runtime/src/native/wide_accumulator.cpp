// SPDX-License-Identifier: MIT
#include "native/wide_accumulator.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "support/rounds_as_written.hpp"

namespace sk {

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
