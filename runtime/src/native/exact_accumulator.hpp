// SPDX-License-Identifier: MIT
//
// A sum of floats, or of products of two, without rounding: an integer that has a place for every bit of every term (Kulisch, Computer
// Arithmetic and Validity, 2008), in digits of 26 bits, lowest first. It counts units of 2^-149, or, of products, of 2^-298.
#pragma once

#include <cstdint>

namespace sk {

class ExactAccumulator {
 public:
  enum class Of : std::uint8_t { Floats, Products };

  explicit ExactAccumulator(Of terms) : digitCount_(terms == Of::Products ? 24 : 12) {}

  /// `count` terms more, of which 2^36 have room.
  void add(std::int64_t count, const float* x);
  void add(std::int64_t count, const float* x, const float* y);
  void add(const ExactAccumulator& other);
  /// Forgets all terms.
  void clear() { *this = ExactAccumulator(digitCount_ == mostDigits ? Of::Products : Of::Floats); }

  /// The nearest float, ties to even. Infinities of both signs and NaN give NaN; -0 is the sum of zeros only where all are -0.
  float rounded() const;

 private:
  static constexpr int mostDigits = 24;

  /// What has been added, beside -0.
  enum Flag : std::uint32_t { HasOther = 1, HasInfinity = 2, HasNegativeInfinity = 4, HasNaN = 8 };

  int unit() const { return digitCount_ == mostDigits ? -298 : -149; }
  template <class... Factors>
  void addAll(std::int64_t count, const Factors*... x);
  template <class... Factors>
  void addBlock(int count, const Factors*... x);
  void addOne(float x);
  void addOne(float x, float y);
  void addWhole(double x);

  int digitCount_;
  std::int64_t digits_[mostDigits] = {};  ///< of more than 26 bits until they are settled
  std::uint32_t flags_ = 0;
};

}  // namespace sk
