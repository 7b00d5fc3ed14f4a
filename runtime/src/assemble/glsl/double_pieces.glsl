// SPDX-License-Identifier: MIT
//
// Functions that several intrinsics of doubles share. Both representations have the same text, except for the
// few functions that use bits. D(x) is a constant. sk_exponent: e of x = m * 2^e with m in [sqrt(1/2),
// sqrt(2)). sk_cut: the upper bits, few enough that products of two are exact.
// A section begins with `////` and its name in C++; glsl_text/double_pieces.hpp defines it as a constant.

//// nativeBasics
sk_double sk_sum(sk_double a, sk_double b) {
  sk_precise double s = sk_keep(sk_value(a) + sk_value(b));
  return sk_of(s);
}
int sk_exponent(sk_double a) { return int(a.bits.y - 0x3fe6a09eu) >> 20; }
sk_double sk_cut(sk_double a) { return sk_double(a.bits & uvec2(0xf8000000u, 0xffffffffu)); }

//// pairBasics
sk_double sk_sum(sk_double a, sk_double b) { return sk_add(a, b); }
int sk_exponent(sk_double a) { return int(floatBitsToUint(a.hi) - 0x3f3504f3u) >> 23; }
sk_double sk_cut(sk_double a) { return sk_double(a.hi, 0.0); }
// p * x + c, for |c| not below |p * x|.
sk_double sk_step(sk_double p, sk_double x, sk_double c) {
  sk_double m = sk_two_product(p.hi, x.hi);
  sk_precise float s = sk_keep(c.hi + m.hi);
  sk_precise float t = sk_keep(s - c.hi);
  sk_precise float e = sk_keep(m.hi - t);
  return sk_join(s, e + (c.lo + (m.lo + (p.hi * x.lo + p.lo * x.hi))));
}

//// nativeKeep
double sk_keep(double x) { return packDouble2x32(unpackDouble2x32(x) ^ uvec2(sk_zero)); }

//// commonBasics
// a, negated where b is negative.
sk_double sk_toggle(sk_double a, sk_double b) { return sk_choose(sk_is_negative(b), sk_neg(a), a); }
sk_double sk_infinity() { return sk_unpack(uvec2(0u, 0x7ff00000u)); }
sk_double sk_nan() { return sk_unpack(uvec2(0u, 0x7ff80000u)); }

//// expLimit
// exp(r) - 1 for |r| <= ln(2) / 2 and a bit.
sk_double sk_exp_tail(sk_double r) { return sk_add(r, sk_mul(sk_mul(r, r), sk_exp_polynomial(r))); }
// exp(x) for |x| > 800.
sk_double sk_exp_limit(float x) { return sk_choose(x > 0.0, sk_infinity(), D(0.0)); }

//// expReduced
// exp(r) - 1 of x = r + n * ln(2), for |x| <= 800 (ln(2) in two parts: Cody and Waite, 1980).
sk_double sk_exp_reduced(sk_double x, out int n) {
  float k = roundEven(clamp(sk_to_float(x), -1e3, 1e3) * 1.44269504);
  n = int(k);
  sk_double m = sk_to_double(-k), r = sk_sum(x, sk_mul(m, D(0.69314718036912382)));
  return sk_exp_tail(sk_add(r, sk_mul(m, D(1.9082149292705877e-10))));
}

//// logOf
// f - log(1 + f) for 1 + f in [sqrt(1/2), sqrt(2)), by s = f / (2 + f) (as in Sun's fdlibm).
sk_double sk_log_tail(sk_double f) {
  sk_double s = sk_div(f, sk_add(f, D(2.0))), z = sk_mul(s, s), h = sk_mul(D(0.5), sk_mul(f, f));
  sk_double p = sk_mul(z, sk_add(sk_mul(z, sk_log_polynomial(z)), D(0.66666666666666667)));
  return sk_sub(h, sk_mul(s, sk_add(h, p)));
}
// log((1 + f) * 2^e).
sk_double sk_log_of(sk_double f, int e) {
  sk_double k = sk_to_double(float(e));
  sk_double low = sk_sub(f, sk_sub(sk_log_tail(f), sk_mul(k, D(1.9082149292705877e-10))));
  return sk_add(sk_mul(k, D(0.69314718036912382)), low);
}

//// logLimited
// x = (1 + f) * 2^e.
sk_double sk_fraction(sk_double x, out int e) {
  e = sk_exponent(x);
  return sk_sub(sk_ldexp(x, -e), D(1.0));
}
// The logarithm y of x, but where x is no positive finite number. Numbers that sk_ldexp() takes for 0 are 0.
sk_double sk_log_limited(sk_double x, sk_double y) {
  if (sk_isnan(x)) return x;
  if (sk_equal(sk_ldexp(x, 0), D(0.0))) return sk_neg(sk_infinity());
  return sk_choose(sk_is_negative(x), sk_nan(), sk_choose(sk_isinf(x), x, y));
}

//// logPlus
// log(1 + t) + more * log(2), of a finite t > -1. What 1 + t is rounded by comes back into the fraction.
sk_double sk_log_plus(sk_double t, int more) {
  sk_double u = sk_sum(D(1.0), t), lost = sk_sub(t, sk_sum(u, D(-1.0)));
  int e = sk_exponent(u);
  sk_double f = sk_sub(sk_ldexp(u, -e), D(1.0));
  return sk_log_of(sk_add(f, sk_ldexp(lost, -e)), e + more);
}

//// power
// x^y of a finite x > 0. The logarithm is a sum of two numbers, as in Sun's fdlibm: with m = (1 + s) / (1 - s),
// log2(m) = 2 / (3 ln 2) * s * (3 + s^2 + 3/5 s^4 + ...), where s and the sums are cut in halves.
sk_double sk_power(sk_double x, sk_double y) {
  int e = sk_exponent(x);
  sk_double m = sk_ldexp(x, -e), n = sk_to_double(float(e));
  sk_double u = sk_sub(m, D(1.0)), v = sk_sum(m, D(1.0)), s = sk_div(u, v);
  sk_double sh = sk_cut(s), vh = sk_cut(v), vl = sk_sub(m, sk_sum(vh, D(-1.0)));
  sk_double left = sk_sum(u, sk_neg(sk_mul(sh, vh)));
  sk_double sl = sk_div(sk_sum(left, sk_neg(sk_mul(sh, vl))), v);
  sk_double w = sk_mul(s, s), wh = sk_mul(sh, sh);
  sk_double tail = sk_mul(sk_mul(w, w), sk_mul(D(1.5), sk_log_polynomial(w)));
  tail = sk_add(tail, sk_mul(sl, sk_add(sh, s)));
  sk_double three = sk_sum(D(3.0), wh), lower = sk_sub(wh, sk_sum(three, D(-3.0)));
  sk_double ah = sk_cut(sk_add(three, tail));
  sk_double al = sk_add(sk_sub(tail, sk_sum(ah, sk_neg(three))), lower);
  sk_double ph = sk_mul(sh, ah), pl = sk_add(sk_mul(sl, ah), sk_mul(al, s));
  sk_double qh = sk_cut(sk_add(ph, pl)), ql = sk_sub(pl, sk_sum(qh, sk_neg(ph)));
  sk_double zh = sk_mul(D(0.96179628372192383), qh);
  sk_double zl = sk_add(sk_mul(D(4.1020405177678161e-07), qh), sk_mul(ql, D(0.96179669392597555)));
  sk_double th = sk_cut(sk_add(sk_add(zh, zl), n));
  sk_double tl = sk_sub(zl, sk_sum(sk_sum(th, sk_neg(n)), sk_neg(zh)));
  float f = sk_to_float(y);
  if (abs(f) > 1e27) y = sk_to_double(f > 0.0 ? 1e27 : -1e27);
  sk_double yh = sk_cut(y), product = sk_mul(yh, th);
  sk_double below = sk_add(sk_mul(sk_sub(y, yh), th), sk_mul(y, tl));
  f = sk_to_float(product);
  float k = roundEven(clamp(f, -2e3, 2e3));
  sk_double r = sk_add(sk_sum(product, sk_to_double(-k)), below);
  sk_double p = sk_add(D(1.0), sk_exp_tail(sk_mul(r, D(0.69314718055994529))));
  return sk_choose(abs(f) > 1200.0, sk_exp_limit(f), sk_ldexp(p, int(k)));
}

//// reduceLarge
// The upper half of the 64 bits of a product. (By another name than that for floats, which may be there.)
uint sk_high(uint a, uint b) {
  uint low = (a & 0xffffu) * (b & 0xffffu), middle = (a >> 16) * (b & 0xffffu) + (low >> 16);
  uint other = (a & 0xffffu) * (b >> 16) + (middle & 0xffffu);
  return (a >> 16) * (b >> 16) + (middle >> 16) + (other >> 16);
}
// 64 bits of zero, and the bits of 2/pi.
const uint sk_two_over_pi_bits[40] = uint[40](
  0u, 0u, 0xa2f9836eu, 0x4e441529u, 0xfc2757d1u, 0xf534ddc0u, 0xdb629599u, 0x3c439041u, 0xfe5163abu, 0xdebbc561u,
  0xb7246e3au, 0x424dd2e0u, 0x06492eeau, 0x09d1921cu, 0xfe1deb1cu, 0xb129a73eu, 0xe88235f5u, 0x2ebb4484u, 0xe99c7026u,
  0xb45f7e41u, 0x3991d639u, 0x835339f4u, 0x9c845f8bu, 0xbdf9283bu, 0x1ff897ffu, 0xde05980fu, 0xef2f118bu, 0x5a0a6d1fu,
  0x6d367ecfu, 0x27cb09b7u, 0x4f463f66u, 0x9e5fea2du, 0x7527bac7u, 0xebe5f17bu, 0x3d0739f7u, 0x8a5292eau, 0x6bfb5fb1u,
  0x1f8d5d08u, 0x56033046u, 0xfc7b6babu);
uint sk_two_over_pi_at(int bit) {
  int word = bit >> 5, shift = bit & 31;
  return (sk_two_over_pi_bits[word] << shift) | ((sk_two_over_pi_bits[word + 1] >> 1) >> (31 - shift));
}
void sk_accumulate(inout uint sum, inout uint carry, uint term) {
  sum += term;
  carry += sum < term ? 1u : 0u;
}
// A finite x >= 2^20 as r + q * pi/2, q modulo 4 (Payne and Hanek, SIGNUM Newsletter 18, 1983). The product of x and 2/pi is
// computed in fixed point, from those 192 bits of 2/pi that matter to its last two integer bits and 126 of its fraction.
sk_double sk_reduce_large(sk_double x, out int q) {
  uvec2 b = sk_pack(x);
  uint high = (b.y & 0xfffffu) | 0x100000u;
  int bit = int((b.y >> 20) & 0x7ffu) - 1013;
  uint digits[4];
  uint carry = 0u;
  for (int i = 3; i >= 0; --i) {
    uint sum = carry, next = sk_two_over_pi_at(bit + 32 * i + 32);
    carry = 0u;
    sk_accumulate(sum, carry, b.x * sk_two_over_pi_at(bit + 32 * i));
    sk_accumulate(sum, carry, sk_high(b.x, next));
    sk_accumulate(sum, carry, high * next);
    sk_accumulate(sum, carry, sk_high(high, sk_two_over_pi_at(bit + 32 * i + 64)));
    digits[i] = sum;
  }
  uint quadrant = (digits[0] + 0x20000000u) >> 30;
  digits[0] -= quadrant << 30;
  q = int(quadrant & 3u);
  bool negative = (digits[0] & 0x80000000u) != 0u;
  sk_double r = D(0.0);
  for (int i = 3; i >= 0; --i) {
    uint digit = negative ? ~digits[i] : digits[i];   // of -1 - r, which is near enough
    r = sk_add(sk_mul(r, D(2.3283064365386963e-10)), sk_to_double(digit));
  }
  r = sk_mul(r, D(1.4629180792671596e-09));   // 2 pi / 2^32
  return sk_choose(negative, sk_neg(r), r);
}

//// wave
// A finite x >= 0 as r + q * pi/2 with |r| <= pi/4 and a bit. Below 10^6, of pi/2 in four parts, whose products with numbers
// up to 2^20 are exact, but for the last.
sk_double sk_reduce(sk_double x, out int q) {
  if (sk_to_float(x) >= 1e6) return sk_reduce_large(x, q);
  float n = sk_to_float(sk_round(sk_mul(x, D(0.63661977236758138))));
  q = int(n);
  sk_double k = sk_to_double(-n);
  sk_double r = sk_sum(x, sk_mul(k, D(1.570796325802803)));
  r = sk_sum(r, sk_mul(k, D(9.9209357395935172e-10)));
  r = sk_sum(r, sk_mul(k, D(5.7211887096635749e-18)));
  return sk_sum(r, sk_mul(k, D(1.6446256936324258e-26)));
}
// The sine or the cosine of |r| <= pi/4 and a bit.
sk_double sk_wave_part(sk_double r, bool isCosine) {
  sk_double z = sk_mul(r, r), p = sk_mul(z, sk_wave_polynomial(z, isCosine));
  sk_double scale = sk_mul(sk_choose(isCosine, z, r), sk_choose(isCosine, sk_sub(p, D(0.5)), p));
  return sk_add(sk_choose(isCosine, D(1.0), r), scale);
}
// The sine of x + turns * pi/2 for x >= 0.
sk_double sk_wave(sk_double x, int turns) {
  if (sk_isnan(x) || sk_isinf(x)) return sk_nan();
  int q;
  sk_double r = sk_reduce(x, q);
  q += turns;
  sk_double wave = sk_wave_part(r, (q & 1) != 0);
  return sk_choose((q & 2) == 0, wave, sk_neg(wave));
}

//// angle
// The angle between the first axis and (x, y), both finite, not negative, and not both 0: that of a multiple of it, 0, 1/2 or 1,
// and the rest, whose tangent is below sqrt(5) - 2.
sk_double sk_angle(sk_double y, sk_double x) {
  bool steep = sk_less(x, y);
  sk_double low = sk_choose(steep, x, y), high = sk_choose(steep, y, x);
  float t = sk_to_float(low) / sk_to_float(high);
  sk_double c = sk_to_double(t > 0.72 ? 1.0 : t > 0.236 ? 0.5 : 0.0);
  sk_double s = sk_div(sk_sub(low, sk_mul(c, high)), sk_add(high, sk_mul(c, low))), z = sk_mul(s, s);
  sk_double angle = sk_add(s, sk_mul(s, sk_mul(z, sk_atan_polynomial(z))));
  if (t > 0.236) angle = sk_add(sk_choose(t > 0.72, D(0.78539816339744828), D(0.46364760900080609)), angle);
  return sk_choose(steep, sk_sub(D(1.5707963267948966), angle), angle);
}

//// errorTail
// erfc(a) for 3/4 <= a <= 27.3. exp(-a^2) is that of the square of the upper bits of a, which is exact, and of what this lacks.
sk_double sk_erfc_part(sk_double a) {
  sk_double s = sk_div(D(1.0), sk_add(a, D(3.0))), t = sk_mul(sk_sub(a, D(3.0)), s);
  sk_double h = sk_cut(a), rest = sk_exp_tail(sk_neg(sk_mul(sk_sub(a, h), sk_add(a, h))));
  int n;
  sk_double e = sk_exp_reduced(sk_neg(sk_mul(h, h)), n);
  sk_double power = sk_add(D(1.0), sk_add(e, sk_add(rest, sk_mul(e, rest))));
  return sk_ldexp(sk_mul(sk_mul(s, sk_erfc_polynomial(t)), power), n);
}
