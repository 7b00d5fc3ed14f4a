// SPDX-License-Identifier: MIT
//
// A sum of doubles or of __float128, or of products of two, without rounding: the ExactAccumulator of
// reference devices. It holds only digits that terms have reached, because a place for every bit of every
// __float128 would take 8 KiB.
#pragma once

#include <cstdint>
#include <vector>

#include "sk/native/quad_type.hpp"

namespace sk {

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
