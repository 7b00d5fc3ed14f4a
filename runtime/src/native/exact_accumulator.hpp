// SPDX-License-Identifier: MIT
//
// A sum of floats, or of products of two, without rounding: an integer with a place for every bit of every
// term (Kulisch, Computer Arithmetic and Validity, 2008), in digits of 26 bits, lowest first. Its unit is
// 2^-149 for floats and 2^-298 for products.
//
// A sum of doubles or of __float128, or of products of two, without rounding: the ExactAccumulator of
// reference devices. It holds only digits that terms have reached, because a place for every bit of every
// __float128 would take 8 KiB.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sk/exact_digits.hpp"
#include "sk/native/quad_type.hpp"

namespace sk {

class ExactAccumulator {
 public:
  enum class Of : std::uint8_t { Floats, Products };

  explicit ExactAccumulator(Of terms) : digitCount_(terms == Of::Products ? 24 : 12) {}

  /// Adds `count` terms.
  void add(std::int64_t count, const float* x);
  void add(std::int64_t count, const float* x, const float* y);
  void add(const ExactAccumulator& other);
  /// Forgets all terms.
  void clear() { *this = ExactAccumulator(digitCount_ == mostDigits ? Of::Products : Of::Floats); }

  /// The nearest float, ties to even. NaN if the terms include infinities of both signs or a NaN; -0 only if
  /// all of them are -0.
  float rounded() const;

  /// All that has been added, in words whose sums over several accumulators are the words of their sum. There may be
  /// Load::most of them.
  std::vector<std::int64_t> words() const;
  /// The accumulator that has such words.
  static ExactAccumulator ofWords(std::span<const std::int64_t> words);

 private:
  using Load = program::DigitLoad<std::int64_t>;
  static constexpr int mostDigits = 24;

  /// What has been added, apart from -0.
  enum Flag : std::uint32_t { HasOther = 1, HasInfinity = 2, HasNegativeInfinity = 4, HasNaN = 8 };

  int unit() const { return digitCount_ == mostDigits ? -298 : -149; }
  template <class... Factors>
  void addAll(std::int64_t count, const Factors*... x);
  template <class... Factors>
  void addBlock(int count, const Factors*... x);
  void addOne(float x);
  void addOne(float x, float y);
  void addWhole(double x);
  /// Makes room for numbers with this load, which are going to be added.
  void reserve(Load load);

  int digitCount_;
  std::int64_t digits_[mostDigits] = {};
  Load load_;  ///< of the digits
  std::uint32_t flags_ = 0;
};

/// The base class for both types.
class WideAccumulator {
 public:
  void add(const WideAccumulator& other);
  /// Forgets all terms.
  void clear() { *this = WideAccumulator(); }

 protected:
  void addTerm(native::Quad x);
  /// The nearest number, ties to even. NaN if the terms include infinities of both signs or a NaN; -0 only if
  /// all of them are -0.
  double nearestDouble() const;
  native::Quad nearestQuad() const;

 private:
  /// What has been added, apart from -0.
  enum Flag : std::uint32_t { HasOther = 1, HasInfinity = 2, HasNegativeInfinity = 4, HasNaN = 8 };

  /// Makes room for digits [first, end).
  void reach(int first, int end);
  void settle();
  void negate();
  template <class Format>
  typename Format::Bits nearest() const;

  int first_ = 0;  ///< the number of the lowest digit; digit 0 counts units of 2^-16494
  std::vector<std::int64_t> digits_;  ///< longer than 32 bits until they are settled
  std::int64_t unsettled_ = 0;  ///< terms since the last settle()
  std::uint32_t flags_ = 0;
};

template <class Real>
class WideSum : public WideAccumulator {
 public:
  void add(std::int64_t count, const Real* x);
  void add(std::int64_t count, const Real* x, const Real* y);
  using WideAccumulator::add;

  /// The nearest number, ties to even.
  Real rounded() const;
};

extern template class WideSum<double>;
extern template class WideSum<native::Quad>;

}  // namespace sk
