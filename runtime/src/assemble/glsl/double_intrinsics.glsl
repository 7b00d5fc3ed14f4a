// SPDX-License-Identifier: MIT
//
// Intrinsics of one double, in both representations. D(x) is a constant.
// A section begins with `////` and its name in C++; glsl_text/double_intrinsics.hpp defines it as a constant.

//// sin
sk_double sk_sin(sk_double x) { return sk_toggle(sk_wave(sk_abs(x), 0), x); }

//// cos
sk_double sk_cos(sk_double x) { return sk_wave(sk_abs(x), 1); }

//// tan
sk_double sk_tan(sk_double x) {
  if (sk_isnan(x) || sk_isinf(x)) return sk_nan();
  int q;
  sk_double r = sk_reduce(sk_abs(x), q), s = sk_wave_part(r, false), c = sk_wave_part(r, true);
  bool odd = (q & 1) != 0;
  return sk_toggle(sk_div(sk_choose(odd, sk_neg(c), s), sk_choose(odd, s, c)), x);
}

//// asin
sk_double sk_asin(sk_double x) {
  sk_double a = sk_abs(x), one = D(1.0);
  if (sk_isnan(x) || sk_less(one, a)) return sk_nan();
  return sk_toggle(sk_angle(a, sk_sqrt(sk_mul(sk_sub(one, a), sk_add(one, a)))), x);
}

//// acos
sk_double sk_acos(sk_double x) {
  sk_double a = sk_abs(x), one = D(1.0);
  if (sk_isnan(x) || sk_less(one, a)) return sk_nan();
  sk_double angle = sk_angle(sk_sqrt(sk_mul(sk_sub(one, a), sk_add(one, a))), a);
  return sk_choose(sk_is_negative(x), sk_sub(D(3.1415926535897931), angle), angle);
}

//// atan
sk_double sk_atan(sk_double x) {
  if (sk_isnan(x)) return x;
  sk_double a = sk_abs(x), most = D(1e30);
  return sk_toggle(sk_angle(sk_choose(sk_less(most, a), most, a), D(1.0)), x);
}

//// atan2
sk_double sk_atan2(sk_double y, sk_double x) {
  if (sk_isnan(x) || sk_isnan(y)) return sk_nan();
  sk_double a = sk_ldexp(sk_abs(x), 0), b = sk_ldexp(sk_abs(y), 0), zero = D(0.0), one = D(1.0);
  sk_double larger = sk_choose(sk_less(a, b), b, a);
  int e = sk_exponent(larger);
  if (sk_isinf(larger)) {
    a = sk_choose(sk_isinf(a), one, zero);
    b = sk_choose(sk_isinf(b), one, zero);
  } else if (sk_equal(larger, zero)) {
    a = one;
  } else {
    a = sk_ldexp(a, 60 - e);   // the smaller one stays far from 0 where the quotient does
    b = sk_ldexp(b, 60 - e);
  }
  sk_double angle = sk_angle(b, a);
  return sk_toggle(sk_choose(sk_is_negative(x), sk_sub(D(3.1415926535897931), angle), angle), y);
}

//// sinh
sk_double sk_sinh(sk_double x) {
  if (sk_isnan(x)) return x;
  sk_double a = sk_abs(x), one = D(1.0);
  float f = sk_to_float(a);
  if (f > 800.0) return sk_toggle(sk_infinity(), x);
  int n;
  sk_double e = sk_exp_reduced(a, n), t = sk_add(sk_ldexp(e, n), sk_sub(sk_ldexp(one, n), one));
  sk_double y = sk_mul(D(0.5), sk_add(t, sk_div(t, sk_add(t, one))));
  return sk_toggle(sk_choose(f < 22.0, y, sk_ldexp(sk_add(one, e), n - 1)), x);
}

//// cosh
sk_double sk_cosh(sk_double x) {
  if (sk_isnan(x)) return x;
  sk_double a = sk_abs(x);
  if (sk_to_float(a) > 800.0) return sk_infinity();
  int n;
  sk_double e = sk_exp_reduced(a, n), y = sk_ldexp(sk_add(D(1.0), e), n - 1);
  return sk_add(y, sk_div(D(0.25), y));
}

//// tanh
sk_double sk_tanh(sk_double x) {
  if (sk_isnan(x)) return x;
  sk_double a = sk_abs(x), one = D(1.0);
  if (sk_to_float(a) > 22.0) return sk_toggle(one, x);
  int n;
  sk_double e = sk_exp_reduced(sk_add(a, a), n), t = sk_add(sk_ldexp(e, n), sk_sub(sk_ldexp(one, n), one));
  return sk_toggle(sk_div(t, sk_add(t, D(2.0))), x);
}

//// asinh
sk_double sk_asinh(sk_double x) {
  if (sk_isnan(x) || sk_isinf(x)) return x;
  sk_double a = sk_abs(x), z = sk_mul(a, a), one = D(1.0);
  bool huge = sk_less(D(1e18), a);   // then sqrt(1 + x^2) is x
  sk_double t = sk_add(a, sk_div(z, sk_add(one, sk_sqrt(sk_add(one, z)))));
  return sk_toggle(sk_log_plus(sk_choose(huge, a, t), huge ? 1 : 0), x);
}

//// acosh
sk_double sk_acosh(sk_double x) {
  if (sk_isnan(x) || sk_less(x, D(1.0))) return sk_nan();
  if (sk_isinf(x)) return x;
  sk_double t = sk_sub(x, D(1.0));
  bool huge = sk_less(D(1e18), x);
  return sk_log_plus(sk_choose(huge, x, sk_add(t, sk_sqrt(sk_mul(t, sk_add(t, D(2.0)))))), huge ? 1 : 0);
}

//// atanh
sk_double sk_atanh(sk_double x) {
  sk_double a = sk_abs(x), one = D(1.0);
  if (sk_isnan(x) || sk_less(one, a)) return sk_nan();
  if (sk_equal(a, one)) return sk_toggle(sk_infinity(), x);
  return sk_toggle(sk_mul(D(0.5), sk_log_plus(sk_div(sk_add(a, a), sk_sub(one, a)), 0)), x);
}

//// exp
sk_double sk_exp(sk_double x) {
  if (sk_isnan(x)) return x;
  float f = sk_to_float(x);
  if (abs(f) > 800.0) return sk_exp_limit(f);
  int n;
  sk_double e = sk_exp_reduced(x, n);
  return sk_ldexp(sk_add(D(1.0), e), n);
}

//// exp2
sk_double sk_exp2(sk_double x) {
  if (sk_isnan(x)) return x;
  float f = sk_to_float(x);
  if (abs(f) > 1200.0) return sk_exp_limit(f);
  float n = roundEven(f);
  sk_double r = sk_sub(x, sk_to_double(n));
  return sk_ldexp(sk_add(D(1.0), sk_exp_tail(sk_mul(r, D(0.69314718055994529)))), int(n));
}

//// log
sk_double sk_log(sk_double x) {
  int e;
  sk_double f = sk_fraction(x, e);
  return sk_log_limited(x, sk_log_of(f, e));
}

//// log2
sk_double sk_log2(sk_double x) {
  int e;
  sk_double f = sk_fraction(x, e), y = sk_mul(sk_sub(f, sk_log_tail(f)), D(1.4426950408889634));
  return sk_log_limited(x, sk_add(sk_to_double(float(e)), y));
}

//// log10
sk_double sk_log10(sk_double x) {
  int e;
  sk_double f = sk_fraction(x, e), k = sk_to_double(float(e));
  sk_double y = sk_mul(sk_sub(f, sk_log_tail(f)), D(0.43429448190325182));
  y = sk_add(y, sk_mul(k, D(1.1451100898021838e-10)));
  return sk_log_limited(x, sk_add(sk_mul(k, D(0.30102999554947019)), y));
}

//// hypot
sk_double sk_hypot(sk_double x, sk_double y) {
  if (sk_isinf(x) || sk_isinf(y)) return sk_infinity();
  if (sk_isnan(x) || sk_isnan(y)) return sk_nan();
  sk_double a = sk_ldexp(sk_abs(x), 0), b = sk_ldexp(sk_abs(y), 0), larger = sk_choose(sk_less(a, b), b, a);
  if (sk_equal(larger, D(0.0))) return larger;
  int e = sk_exponent(larger);
  a = sk_ldexp(a, -e);
  b = sk_ldexp(b, -e);
  return sk_ldexp(sk_sqrt(sk_add(sk_mul(a, a), sk_mul(b, b))), e);
}

//// log1p
sk_double sk_log1p(sk_double x) {
  sk_double least = D(-1.0);
  if (sk_isnan(x) || sk_less(x, least)) return sk_nan();
  if (sk_equal(x, least)) return sk_neg(sk_infinity());
  if (sk_isinf(x) || sk_less(sk_abs(x), D(1e-18))) return x;
  return sk_log_plus(x, 0);
}

//// expm1
sk_double sk_expm1(sk_double x) {
  if (sk_isnan(x) || sk_less(sk_abs(x), D(1e-18))) return x;
  float f = sk_to_float(x);
  if (f > 800.0) return sk_infinity();
  if (f < -60.0) return D(-1.0);
  int n;
  sk_double e = sk_exp_reduced(x, n), one = D(1.0);
  if (f > 60.0) return sk_ldexp(sk_add(one, e), n);
  return sk_add(sk_ldexp(e, n), sk_sub(sk_ldexp(one, n), one));
}

//// cbrt
// x is m * 8^k with 1/2 < m < 6. Newton's steps need few bits of the quotients, as corrections are small.
sk_double sk_cbrt(sk_double x) {
  sk_double a = sk_ldexp(sk_abs(x), 0);
  if (sk_isnan(x) || sk_isinf(x) || sk_equal(a, D(0.0))) return x;
  int k = (sk_exponent(a) + 1500) / 3 - 500;
  sk_double m = sk_ldexp(a, -3 * k);
  float f = sk_to_float(m), g = exp2(log2(f) * 0.333333333);
  g -= (g * g * g - f) / (3.0 * g * g);
  sk_double y = sk_to_double(g);
  y = sk_sub(y, sk_to_double(sk_to_float(sk_sub(sk_mul(sk_mul(y, y), y), m)) / (3.0 * g * g)));
  y = sk_sub(y, sk_to_double(sk_to_float(sk_sub(sk_mul(sk_mul(y, y), y), m)) / (3.0 * g * g)));
  return sk_toggle(sk_ldexp(y, k), x);
}

//// erf
sk_double sk_erf(sk_double x) {
  if (sk_isnan(x)) return x;
  sk_double a = sk_abs(x), one = D(1.0);
  float f = sk_to_float(a);
  if (f > 6.0) return sk_toggle(one, x);
  if (f < 0.75) return sk_mul(x, sk_erf_polynomial(sk_mul(x, x)));
  return sk_toggle(sk_sub(one, sk_erfc_part(a)), x);
}

//// erfc
sk_double sk_erfc(sk_double x) {
  if (sk_isnan(x)) return x;
  sk_double a = sk_abs(x), one = D(1.0), half_ = D(0.5), zero = D(0.0);
  float f = sk_to_float(a);
  bool below = sk_is_negative(x);
  if (f < 0.75) {
    sk_double error = sk_mul(x, sk_erf_polynomial(sk_mul(x, x)));
    return f < 0.25 || below ? sk_sub(one, error) : sk_sub(half_, sk_sub(error, half_));
  }
  sk_double tail = f > 27.3 ? zero : sk_erfc_part(a);
  return sk_choose(below, sk_sub(D(2.0), tail), tail);
}

//// pow
sk_double sk_pow(sk_double x, sk_double y) {
  sk_double one = D(1.0), zero = D(0.0), a = sk_ldexp(sk_abs(x), 0);
  if (sk_equal(y, zero) || sk_equal(x, one)) return one;
  if (sk_isnan(x) || sk_isnan(y)) return sk_nan();
  bool whole = sk_equal(sk_floor(y), y), below = sk_is_negative(y), negative = sk_is_negative(x);
  sk_double halved = sk_ldexp(y, -1);
  bool odd = whole && !sk_equal(sk_floor(halved), halved);
  sk_double p = sk_choose(sk_equal(a, one), one, sk_power(a, y));
  if (sk_equal(a, zero)) p = sk_choose(below, sk_infinity(), zero);
  else if (sk_isinf(a)) p = sk_choose(below, zero, sk_infinity());
  else if (negative && !whole) return sk_nan();
  return sk_choose(negative && odd, sk_neg(p), p);
}
