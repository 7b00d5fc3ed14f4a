// SPDX-License-Identifier: MIT
#include "support/function_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace numerics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr mpfr_prec_t precision = 200;

/// The exponent of the unit in the last place of the Real nearest to `exact`, which is not infinite.
template <class Real>
mpfr_exp_t unitExponent(const mpfr_t exact) {
  using Limits = std::numeric_limits<Real>;
  const mpfr_exp_t lowest = Limits::min_exponent;
  const mpfr_exp_t highest = Limits::max_exponent;
  const mpfr_exp_t own = mpfr_zero_p(exact) ? lowest : mpfr_get_exp(exact);
  return std::clamp(own, lowest, highest) - Limits::digits;
}

/// Replaces an infinity or a number that is too large for Real by the next power of 2 above the largest Real.
template <class Real>
void limit(mpfr_t x) {
  const int sign = mpfr_signbit(x) ? -1 : 1;
  if (mpfr_inf_p(x) || (mpfr_regular_p(x) && mpfr_get_exp(x) > std::numeric_limits<Real>::max_exponent))
    mpfr_set_si_2exp(x, sign, std::numeric_limits<Real>::max_exponent, MPFR_RNDN);
}

}  // namespace

FunctionOracle::FunctionOracle() { mpfr_inits2(precision, x_, y_, exact_, difference_, nullptr); }
FunctionOracle::~FunctionOracle() { mpfr_clears(x_, y_, exact_, difference_, nullptr); }

template <class Real>
double FunctionOracle::error(Unary function, Real x, Real result) {
  mpfr_set_d(x_, x, MPFR_RNDN);
  function(exact_, x_, MPFR_RNDN);
  return errorOf(result);
}

template <class Real>
double FunctionOracle::error(Binary function, Real x, Real y, Real result) {
  mpfr_set_d(x_, x, MPFR_RNDN);
  mpfr_set_d(y_, y, MPFR_RNDN);
  function(exact_, x_, y_, MPFR_RNDN);
  return errorOf(result);
}

template <class Real>
double FunctionOracle::errorOf(Real result) {
  if (mpfr_nan_p(exact_) || std::isnan(result))
    return mpfr_nan_p(exact_) && std::isnan(result) ? 0 : infinity;
  if (result == 0 && std::signbit(result) != (mpfr_signbit(exact_) != 0)) return infinity;
  mpfr_set_d(difference_, result, MPFR_RNDN);
  limit<Real>(exact_);
  limit<Real>(difference_);
  const mpfr_exp_t unit = unitExponent<Real>(exact_);
  mpfr_sub(difference_, exact_, difference_, MPFR_RNDN);
  mpfr_mul_2si(difference_, difference_, -unit, MPFR_RNDN);
  return std::fabs(mpfr_get_d(difference_, MPFR_RNDN));
}

template double FunctionOracle::error(Unary, float, float);
template double FunctionOracle::error(Unary, double, double);
template double FunctionOracle::error(Binary, float, float, float);
template double FunctionOracle::error(Binary, double, double, double);

int floorModulo(mpfr_t result, const mpfr_t x, const mpfr_t y, mpfr_rnd_t rounding) {
  const int inexact = mpfr_fmod(result, x, y, rounding);
  if (mpfr_nan_p(result) || mpfr_zero_p(result) || mpfr_signbit(result) == mpfr_signbit(y)) return inexact;
  return mpfr_add(result, result, y, rounding);
}

template <class Real>
std::vector<Real> nearMultiplesOfHalfPi(int first, int others) {
  using Limits = std::numeric_limits<Real>;
  std::vector<Real> found;
  mpfr_t multiple;
  mpfr_init2(multiple, 1200);
  const auto add = [&](double factor) {
    mpfr_const_pi(multiple, MPFR_RNDN);
    mpfr_div_2ui(multiple, multiple, 1, MPFR_RNDN);
    mpfr_mul_d(multiple, multiple, factor, MPFR_RNDN);
    const auto nearest = static_cast<Real>(Limits::digits == 24 ? mpfr_get_flt(multiple, MPFR_RNDN)
                                                                : mpfr_get_d(multiple, MPFR_RNDN));
    for (const Real x : {nearest, std::nextafter(nearest, Real(0)), std::nextafter(nearest, Limits::max())})
      found.insert(found.end(), {x, -x});
  };
  for (int i = 1; i <= first; ++i) add(i);
  for (int i = 0; i < others; ++i) {
    const double exponent = 10 + (Limits::max_exponent - 14.0) * i / others;
    add(std::floor(std::exp2(exponent) * (1 + 0.618 * (i % 7))));
  }
  mpfr_clear(multiple);
  // The floats and the double that are closest to multiples of pi/2.
  for (int shift = 0; shift <= 80; ++shift) found.push_back(std::ldexp(Real(16367173), shift));
  if (Limits::digits == 53) found.push_back(static_cast<Real>(std::ldexp(6381956970095103.0, 797)));
  return found;
}

template std::vector<float> nearMultiplesOfHalfPi(int, int);
template std::vector<double> nearMultiplesOfHalfPi(int, int);

template <class Real>
std::vector<Real> specialNumbers() {
  using Limits = std::numeric_limits<Real>;
  const Real one = 1, whole = std::ldexp(one, Limits::digits - 1);
  std::vector<Real> positive = {
      0, Limits::denorm_min(), Limits::min(), Limits::min() / 64, Limits::epsilon() / 2, 1e-30F, 0.41421357F,
      0.5F, 0.70710677F, one - Limits::epsilon() / 2, one, one + Limits::epsilon(), 1.4142135F, 1.5F, 2, 3,
      9.01F, 10, 22, 44.3F, 1000, 1e30F, Limits::max(), Limits::infinity(), Limits::quiet_NaN(),
      // where halves end, and where all numbers are even
      whole - Real(0.5), whole, whole + 1, 2 * whole - 1, 2 * whole, 2 * whole + 2, 256 * whole};
  // The arguments at which exponentials become infinite or 0, and their neighbours.
  for (const double end : {Limits::max_exponent * 1.0, Limits::min_exponent - 1.0,
                           Limits::min_exponent - Limits::digits * 1.0}) {
    for (const double unit : {1.0, std::log(2.0)}) {
      const auto x = static_cast<Real>(std::fabs(end * unit));
      positive.insert(positive.end(), {x, std::nextafter(x, Real(0)), std::nextafter(x, Limits::max()),
                                       x + static_cast<Real>(0.6931471805599453)});
    }
  }
  std::vector<Real> all;
  for (const Real x : positive) all.insert(all.end(), {x, -x});
  return all;
}

template std::vector<float> specialNumbers();
template std::vector<double> specialNumbers();

}  // namespace numerics
