// SPDX-License-Identifier: MIT
#include "support/function_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace numerics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr mpfr_prec_t precision = 160;

/// The unit in the last place of the float next to a finite number.
double unitOf(double exact) {
  const int exponent = exact == 0 ? -126 : std::clamp(std::ilogb(exact), -126, 127);
  return std::ldexp(1.0, exponent - 23);
}

}  // namespace

FunctionOracle::FunctionOracle() { mpfr_inits2(precision, x_, y_, exact_, difference_, nullptr); }
FunctionOracle::~FunctionOracle() { mpfr_clears(x_, y_, exact_, difference_, nullptr); }

double FunctionOracle::error(Unary function, float x, float result) {
  mpfr_set_flt(x_, x, MPFR_RNDN);
  function(exact_, x_, MPFR_RNDN);
  return errorOf(result);
}

double FunctionOracle::error(Binary function, float x, float y, float result) {
  mpfr_set_flt(x_, x, MPFR_RNDN);
  mpfr_set_flt(y_, y, MPFR_RNDN);
  function(exact_, x_, y_, MPFR_RNDN);
  return errorOf(result);
}

double FunctionOracle::errorOf(float result) {
  if (mpfr_nan_p(exact_) || std::isnan(result))
    return mpfr_nan_p(exact_) && std::isnan(result) ? 0 : infinity;
  if (result == 0 && std::signbit(result) != (mpfr_signbit(exact_) != 0)) return infinity;
  if (mpfr_cmpabs_ui(exact_, 1) > 0 && mpfr_get_exp(exact_) > 128 && !mpfr_inf_p(exact_))
    mpfr_set_inf(exact_, mpfr_sgn(exact_));
  if (mpfr_inf_p(exact_)) mpfr_set_d(exact_, std::copysign(0x1p128, mpfr_sgn(exact_)), MPFR_RNDN);
  const double finite = std::isinf(result) ? std::copysign(0x1p128, result) : double{result};
  mpfr_sub_d(difference_, exact_, finite, MPFR_RNDN);
  return std::fabs(mpfr_get_d(difference_, MPFR_RNDN)) / unitOf(mpfr_get_d(exact_, MPFR_RNDN));
}

int floorModulo(mpfr_t result, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding) {
  const int inexact = mpfr_fmod(result, x, y, rounding);
  if (mpfr_nan_p(result) || mpfr_zero_p(result) || mpfr_signbit(result) == mpfr_signbit(y)) return inexact;
  return mpfr_add(result, result, y, rounding);
}

std::vector<float> nearMultiplesOfHalfPi(int first, int others) {
  std::vector<float> found;
  mpfr_t multiple;
  mpfr_init2(multiple, 400);
  const auto add = [&](double factor) {
    mpfr_const_pi(multiple, MPFR_RNDN);
    mpfr_div_2ui(multiple, multiple, 1, MPFR_RNDN);
    mpfr_mul_d(multiple, multiple, factor, MPFR_RNDN);
    const float nearest = mpfr_get_flt(multiple, MPFR_RNDN);
    for (const float x : {nearest, std::nextafter(nearest, 0.0F), std::nextafter(nearest, 3e38F)})
      found.insert(found.end(), {x, -x});
  };
  for (int i = 1; i <= first; ++i) add(i);
  for (int i = 0; i < others; ++i)
    add(std::floor(std::exp2(10 + 117.0 * i / others) * (1 + 0.618 * (i % 7))));
  mpfr_clear(multiple);
  // the float above 2^23 that comes closest of all to a multiple, and those of the other powers of 2 next to it
  for (int shift = 0; shift <= 80; ++shift) found.push_back(std::ldexp(16367173.0F, shift));
  return found;
}

std::vector<float> specialFloats() {
  using Limits = std::numeric_limits<float>;
  const float positive[] = {0,
                            Limits::denorm_min(),
                            1e-40F,
                            Limits::min(),
                            1e-30F,
                            0x1p-24F,
                            0.41421357F,
                            0.5F,
                            0.70710677F,
                            0.99999994F,
                            1,
                            1.0000001F,
                            1.4142135F,
                            1.5F,
                            2,
                            3,
                            9.01F,
                            10,
                            44.3F,
                            88.72283F,
                            88.72284F,
                            89.41599F,
                            89.416F,
                            103.97208F,
                            103.97209F,
                            127.99999F,
                            128,
                            149,
                            149.99998F,
                            150,
                            1000,
                            8388607.5F,
                            8388608,
                            8388609,
                            16777215,
                            16777216,
                            16777218,
                            2147483648.0F,
                            1e30F,
                            Limits::max(),
                            Limits::infinity(),
                            Limits::quiet_NaN()};
  std::vector<float> all;
  for (const float x : positive) all.insert(all.end(), {x, -x});
  return all;
}

}  // namespace numerics
