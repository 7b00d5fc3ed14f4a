// SPDX-License-Identifier: MIT
//
// How far a result is from the exact value of a function, by MPFR, and arguments for which functions are hard to compute.
#pragma once

#include <mpfr.h>

#include <vector>

namespace numerics {

using Unary = int (*)(mpfr_t, const mpfr_t, mpfr_rnd_t);
using Binary = int (*)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);

/// An error in units in the last place of the float that is next to the exact value, or infinity where one is NaN and the
/// other not, or where zeros differ in sign. Beyond the largest float all numbers are 2^128.
class FunctionOracle {
 public:
  FunctionOracle();
  ~FunctionOracle();
  FunctionOracle(const FunctionOracle&) = delete;
  FunctionOracle& operator=(const FunctionOracle&) = delete;

  double error(Unary function, float x, float result);
  double error(Binary function, float x, float y, float result);

 private:
  double errorOf(float result);

  mpfr_t x_, y_, exact_, difference_;
};

/// x less y times the floor of their quotient: the intrinsic `mod`.
int floorModulo(mpfr_t result, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding);

/// The floats next to multiples of pi/2: of the first ones, and of others up to the largest floats.
std::vector<float> nearMultiplesOfHalfPi(int first, int others);

/// Every special value, the ends of the ranges of floats, and whole numbers where floats lose their fraction.
std::vector<float> specialFloats();

}  // namespace numerics
