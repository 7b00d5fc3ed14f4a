// SPDX-License-Identifier: MIT
//
// Measures the error of a function's result with MPFR. Also arguments for which functions are hard to compute.
#pragma once

#include <mpfr.h>

#include <vector>

namespace numerics {

using Unary = int (*)(mpfr_t, const mpfr_t, mpfr_rnd_t);
using Binary = int (*)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);

/// Computes the error of a float or double in units in the last place (ulp) of the number nearest to the exact value. The
/// error is infinite if only one of result and exact value is NaN, or if a result of 0 has the wrong sign. Infinities and
/// overflows count as the next power of 2 above the largest number.
class FunctionOracle {
 public:
  FunctionOracle();
  ~FunctionOracle();
  FunctionOracle(const FunctionOracle&) = delete;
  FunctionOracle& operator=(const FunctionOracle&) = delete;

  template <class Real>
  double error(Unary function, Real x, Real result);
  template <class Real>
  double error(Binary function, Real x, Real y, Real result);

 private:
  template <class Real>
  double errorOf(Real result);

  mpfr_t x_, y_, exact_, difference_;
};

/// x - y * floor(x / y): the intrinsic `mod`.
int floorModulo(mpfr_t result, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding);

/// The numbers next to multiples of pi/2: the first `first` multiples, and `others` up to the largest numbers.
template <class Real>
std::vector<Real> nearMultiplesOfHalfPi(int first, int others);

/// Every special value, the ends of functions' ranges, and numbers around the largest fractions.
template <class Real>
std::vector<Real> specialNumbers();

}  // namespace numerics
