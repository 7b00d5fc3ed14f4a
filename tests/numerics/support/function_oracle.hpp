// SPDX-License-Identifier: MIT
//
// How far a result is from the exact value of a function, by MPFR, and arguments for which functions are hard to compute.
#pragma once

#include <mpfr.h>

#include <vector>

namespace numerics {

using Unary = int (*)(mpfr_t, const mpfr_t, mpfr_rnd_t);
using Binary = int (*)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);

/// The error of a float or double in units in the last place of the one that is next to the exact value, or infinity where
/// one is NaN and the other not, or where zeros differ in sign. Beyond the largest number all are the next power of 2.
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

/// x less y times the floor of their quotient: the intrinsic `mod`.
int floorModulo(mpfr_t result, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding);

/// The numbers next to multiples of pi/2: of the first ones, and of others up to the largest numbers.
template <class Real>
std::vector<Real> nearMultiplesOfHalfPi(int first, int others);

/// Every special value, the ends of the ranges of functions, and whole numbers where fractions end.
template <class Real>
std::vector<Real> specialNumbers();

}  // namespace numerics
