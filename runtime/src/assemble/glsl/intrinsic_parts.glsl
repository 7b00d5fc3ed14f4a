// SPDX-License-Identifier: MIT
//
// Functions that several intrinsics of floats share. Coefficients of sin, cos, tan, exp, log, sinh, tanh,
// acosh and atanh are from Cephes (Moshier, 1992); the others are our own minimax polynomials.
// A section begins with `////` and its name in C++; glsl_text/intrinsic_parts.hpp defines it as a constant.

//// toggleSign
// |x| with the sign of y.
float sk_with_sign(float x, float y) {
  return uintBitsToFloat((floatBitsToUint(x) & 0x7fffffffu) | (floatBitsToUint(y) & 0x80000000u));
}
// x, negated where y is negative.
float sk_toggle_sign(float x, float y) {
  return uintBitsToFloat(floatBitsToUint(x) ^ (floatBitsToUint(y) & 0x80000000u));
}

//// scale
// x * 2^n for |n| <= 252, rounded once.
float sk_scale(float x, int n) {
  int half_n = n >> 1;
  sk_precise float y = sk_keep(x * intBitsToFloat((half_n + 127) << 23));
  return y * intBitsToFloat((n - half_n + 127) << 23);
}

//// mantissa
// x = m * 2^e with m in [sqrt(1/2), sqrt(2)), of a positive finite x by its bits: also of one that is too small for arithmetic.
float sk_mantissa(uint bits, out int e) {
  int below = 0;
  if (bits < 0x00800000u) {
    bits = floatBitsToUint(float(bits));
    below = -149;
  }
  int k = int(bits - 0x3f3504f3u) >> 23;
  e = k + below;
  return uintBitsToFloat(bits - uint(k << 23));
}

//// logLimit
// What logarithms are where x is no positive finite number.
float sk_log_limit(float x) {
  uint bits = floatBitsToUint(x);
  if ((bits & 0x7fffffffu) == 0u) return uintBitsToFloat(0xff800000u);
  return uintBitsToFloat(bits == 0x7f800000u ? bits : 0x7fc00000u);
}

//// logTail
// log(1 + f) - f + f^2 / 2, for 1 + f in [sqrt(1/2), sqrt(2)).
float sk_log_tail(float f) {
  float p = 7.0376836292e-2;
  p = p * f - 1.1514610310e-1;
  p = p * f + 1.1676998740e-1;
  p = p * f - 1.2420140846e-1;
  p = p * f + 1.4249322787e-1;
  p = p * f - 1.6668057665e-1;
  p = p * f + 2.0000714765e-1;
  p = p * f - 2.4999993993e-1;
  p = p * f + 3.3333331174e-1;
  return p * f * (f * f);
}

//// log
float sk_log(float x) {
  uint bits = floatBitsToUint(x);
  int e;
  float f = sk_mantissa(bits, e) - 1.0;
  float n = float(e);
  float tail = sk_log_tail(f) - n * 2.12194440e-4;
  float y = (f + (tail - 0.5 * (f * f))) + n * 0.693359375;
  return bits - 1u < 0x7f7fffffu ? y : sk_log_limit(x);
}

//// expScaled
// exp(x) * 2^k for x in [-104, 100]; NaN of NaN, and something of all others.
float sk_exp_scaled(float x, int k) {
  float n = roundEven(x * 1.44269504);
  sk_precise float a = sk_keep(x - n * 0.693359375);
  sk_precise float r = sk_keep(a + n * 2.12194440e-4);
  float p = 1.9875691500e-4;
  p = p * r + 1.3981999507e-3;
  p = p * r + 8.3334519073e-3;
  p = p * r + 4.1665795894e-2;
  p = p * r + 1.6666665459e-1;
  p = p * r + 5.0000001201e-1;
  return sk_scale(1.0 + (r + r * r * p), int(n) + k);
}

//// exp2Part
// 2^r for |r| <= 1/2.
float sk_exp2_part(float r) {
  float p = 1.535342033e-4;
  p = p * r + 1.339887623e-3;
  p = p * r + 9.61843719e-3;
  p = p * r + 5.550332467e-2;
  p = p * r + 2.402264791e-1;
  p = p * r + 6.931472029e-1;
  return 1.0 + r * p;
}

//// cut
// The upper 12 bits of a float: products of two such are exact.
float sk_cut(float x) { return uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u); }

//// power
// x^y of a positive finite x and |y| <= 2^40. The logarithm is the sum of two floats, as in Sun's fdlibm: with m = (1 + s) / (1 - s),
// log2(m) = 2 / (3 ln 2) * s * (3 + s^2 + 3/5 s^4 + ...), where s and the sums are cut in halves.
float sk_power(uint bits, float y) {
  int e;
  float m = sk_mantissa(bits, e);
  float n = float(e);
  float u = m - 1.0;
  float v = m + 1.0;
  float s = u / v;
  float sh = sk_cut(s);
  float vh = sk_cut(v);
  sk_precise float v1 = sk_keep(vh - 1.0);
  sk_precise float vl = sk_keep(m - v1);
  sk_precise float left = sk_keep(u - sh * vh);
  sk_precise float rest = sk_keep(left - sh * vl);
  float sl = rest / v;
  float w = s * s;
  float tail = (0.351278652 * w + 0.4282070043) * w + 0.6000022827;
  tail = w * w * tail + sl * (sh + s);
  float wh = sh * sh;
  sk_precise float three = sk_keep(3.0 + wh);
  sk_precise float lost = sk_keep(three - 3.0);
  sk_precise float lower = sk_keep(wh - lost);
  float ah = sk_cut(three + tail);
  sk_precise float more = sk_keep(ah - three);
  float al = (tail - more) + lower;
  float ph = sh * ah;
  float pl = sl * ah + al * s;
  float qh = sk_cut(ph + pl);
  sk_precise float moved = sk_keep(qh - ph);
  float ql = pl - moved;
  float zh = 0.9619140625 * qh;
  float zl = -1.1736857402e-4 * qh + ql * 0.961796694;
  float th = sk_cut((zh + zl) + n);
  sk_precise float whole = sk_keep(th - n);
  sk_precise float gone = sk_keep(whole - zh);
  float tl = zl - gone;
  float yh = sk_cut(y);
  float product = yh * th;
  float below = (y - yh) * th + y * tl;
  float z = clamp(product + below, -300.0, 300.0);
  float k = roundEven(z);
  sk_precise float r = sk_keep(product - k);
  float p = sk_scale(sk_exp2_part(r + below), int(k));
  return z >= 129.0 ? uintBitsToFloat(0x7f800000u) : z < -151.0 ? 0.0 : p;
}

//// productHigh
// The upper half of the 64 bits of a product.
uint sk_product_high(uint a, uint b) {
  uint low = (a & 0xffffu) * (b & 0xffffu);
  uint middle = (a >> 16) * (b & 0xffffu) + (low >> 16);
  uint other = (a & 0xffffu) * (b >> 16) + (middle & 0xffffu);
  return (a >> 16) * (b >> 16) + (middle >> 16) + (other >> 16);
}

//// reduceLarge
// A finite x >= 2^10 as r + q * pi/2, q modulo 4 (Payne and Hanek, SIGNUM Newsletter 18, 1983). The product of x and 2/pi
// is computed in fixed point, from those 96 bits of 2/pi that matter to its last two integer bits and 62 of its fraction.
const uint sk_two_over_pi[8] = uint[8](0u, 0xa2f9836eu, 0x4e441529u, 0xfc2757d1u, 0xf534ddc0u, 0xdb629599u, 0x3c439041u, 0xfe5163abu);
float sk_reduce_large(float x, out int q) {
  uint bits = floatBitsToUint(x);
  uint mantissa = (bits & 0x7fffffu) | 0x800000u;
  int offset = int(bits >> 23) - 120;
  int first = offset >> 5;
  int shift = offset & 31;
  uint w0 = (sk_two_over_pi[first] << shift) | ((sk_two_over_pi[first + 1] >> 1) >> (31 - shift));
  uint w1 = (sk_two_over_pi[first + 1] << shift) | ((sk_two_over_pi[first + 2] >> 1) >> (31 - shift));
  uint w2 = (sk_two_over_pi[first + 2] << shift) | ((sk_two_over_pi[first + 3] >> 1) >> (31 - shift));
  uint carried = sk_product_high(mantissa, w2);
  uint low = mantissa * w1 + carried;
  uint high = mantissa * w0 + sk_product_high(mantissa, w1) + (low < carried ? 1u : 0u);
  uint quadrant = (high + 0x20000000u) >> 30;
  high -= quadrant << 30;
  bool negative = (high & 0x80000000u) != 0u;
  if (negative) {
    low = ~low + 1u;
    high = ~high + (low == 0u ? 1u : 0u);
  }
  q = int(quadrant & 3u);
  float turn = float(high >> 6) * 5.9604645e-8;
  float rest = float((high << 26) | (low >> 6)) * 1.3877788e-17;
  float cut = uintBitsToFloat(floatBitsToUint(turn) & 0xfffff000u);
  float r = cut * 1.5703125 + ((turn - cut) * 1.5703125 + (turn * 4.83826795e-4 + rest * 1.57079633));
  return negative ? -r : r;
}

//// reduce
// A finite x >= 0 as r + q * pi/2 with |r| <= pi/4 and a bit, q modulo 4. Below 3000, of pi/2 in four parts, whose products with q
// have no more bits than a float, but for the last (Cody and Waite, 1980).
float sk_reduce(float x, out int q) {
  if (x >= 3000.0) return sk_reduce_large(x, q);
  float n = roundEven(x * 0.636619772);
  sk_precise float a = sk_keep(x - n * 1.570556640625);
  sk_precise float b = sk_keep(a - n * 2.396702766418457e-4);
  sk_precise float c = sk_keep(b - n * 1.5890691429376602e-8);
  sk_precise float d = sk_keep(b - c);
  q = int(n) & 3;
  return c + ((d - n * 1.5890691429376602e-8) - n * 2.5633440682570896e-12);
}

//// wave
// The sine and the cosine of |r| <= pi/4 and a bit.
float sk_sin_part(float r) {
  float z = r * r;
  float p = -1.9515295891e-4;
  p = p * z + 8.3321608736e-3;
  p = p * z - 1.6666654611e-1;
  return r + r * (z * p);
}
float sk_cos_part(float r) {
  float z = r * r;
  float p = 2.443315711809948e-5;
  p = p * z - 1.388731625493765e-3;
  p = p * z + 4.166664568298827e-2;
  return 1.0 - (0.5 * z - z * z * p);
}
// The sine of x + turns * pi/2 for x >= 0.
float sk_wave(float x, int turns) {
  if (!(x < uintBitsToFloat(0x7f800000u))) return uintBitsToFloat(0x7fc00000u);
  int q;
  float r = sk_reduce(x, q);
  q += turns;
  float wave = (q & 1) == 0 ? sk_sin_part(r) : sk_cos_part(r);
  return (q & 2) == 0 ? wave : -wave;
}

//// asinPart
// The arc sine of a in [0, 1/2], without a.
float sk_asin_part(float a, float z) {
  float p = 4.216626211e-2;
  p = p * z + 2.417954399e-2;
  p = p * z + 4.547036954e-2;
  p = p * z + 7.495297699e-2;
  p = p * z + 1.666675248e-1;
  return a * (z * p);
}

//// atanPart
// The arc tangent of t in [0, 1].
float sk_atan_part(float t) {
  float z = t * t;
  float p = 2.920688954e-3;
  p = p * z - 1.636791713e-2;
  p = p * z + 4.321184744e-2;
  p = p * z - 7.552213612e-2;
  p = p * z + 1.066600462e-1;
  p = p * z - 1.421105542e-1;
  p = p * z + 1.999377288e-1;
  p = p * z - 3.333315274e-1;
  return t + t * (z * p);
}

//// order
// A number for a float that grows as floats do, from -infinity to infinity, with -0 below 0; it wraps where NaN begin.
uint sk_order(float x) {
  int bits = floatBitsToInt(x);
  return uint(bits ^ ((bits >> 31) & 0x7fffffff));
}

//// min
// Counted from -infinity on, all NaN come last.
float sk_min(float x, float y) { return sk_order(x) - 0x807fffffu <= sk_order(y) - 0x807fffffu ? x : y; }

//// max
// Counted to infinity, all NaN come first.
float sk_max(float x, float y) { return sk_order(x) - 0x7f800001u >= sk_order(y) - 0x7f800001u ? x : y; }

//// saturate
float sk_saturate(float x) { return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; }

//// fmod
// v * 2^20 less a multiple of m, at most about m away from 0. The multiple is wrong by the rounding of a float, and integers that
// wrap still give the difference.
int sk_fmod_step(int v, int m, float c) { return (v << 20) - int(roundEven(float(v) * c)) * m; }
// What is left of x by y, exactly, from the mantissas of both as integers. No loop: drivers put a copy of a function wherever it is
// called, and llvmpipe's compiler takes twice as long for each loop more.
float sk_fmod(float x, float y) {
  int x_bits = floatBitsToInt(x) & 0x7fffffff;
  int y_bits = floatBitsToInt(y) & 0x7fffffff;
  if (y_bits == 0 || y_bits > 0x7f800000 || x_bits >= 0x7f800000) return uintBitsToFloat(0x7fc00000u);
  if (x_bits < y_bits) return x;
  int m = y_bits < 0x800000 ? y_bits : (y_bits & 0x7fffff) | 0x800000;
  int v = x_bits < 0x800000 ? x_bits : (x_bits & 0x7fffff) | 0x800000;
  int e = max(y_bits >> 23, 1);
  int k = max(x_bits >> 23, 1) - e;
  float c = 1048576.0 / float(m);
  int n = k / 20;
  int first = k - n * 20;
  v -= int(roundEven(float(v) * (c * 9.5367431640625e-7))) * m;
  v = (v << first) - int(roundEven(float(v) * (c * intBitsToFloat((first + 107) << 23)))) * m;
  if (n > 0) v = sk_fmod_step(v, m, c);
  if (n > 1) v = sk_fmod_step(v, m, c);
  if (n > 2) {
    v = sk_fmod_step(v, m, c);
    if (n > 3) v = sk_fmod_step(v, m, c);
    if (n > 4) v = sk_fmod_step(v, m, c);
    if (n > 5) v = sk_fmod_step(v, m, c);
    if (n > 6) v = sk_fmod_step(v, m, c);
    if (n > 7) v = sk_fmod_step(v, m, c);
    if (n > 8) v = sk_fmod_step(v, m, c);
    if (n > 9) v = sk_fmod_step(v, m, c);
    if (n > 10) v = sk_fmod_step(v, m, c);
    if (n > 11) v = sk_fmod_step(v, m, c);
    if (n > 12) v = sk_fmod_step(v, m, c);
    if (n > 13) v = sk_fmod_step(v, m, c);
  }
  v += v < 0 ? m : 0;
  v += v < 0 ? m : 0;
  v -= v >= m ? m : 0;
  bool isDenormal = e <= 23 && v < (0x800000 >> (e - 1));
  return sk_with_sign(isDenormal ? intBitsToFloat(v << (e - 1)) : sk_scale(float(v), e - 150), x);
}

//// lengthScale
// The power of 2 by which vectors are multiplied, of whose components the largest has these bits, so that no square overflows or
// vanishes, and no component becomes denormal whose part of the length is not: from 2^95 on 2^-66, from 2^62 on 2^-34, below
// 2^-40 2^86.
float sk_length_scale(uint bits) {
  uint down = bits >= 0x6f000000u ? 0x1e800000u : 0x2e800000u;
  return uintBitsToFloat(bits >= 0x5e800000u ? down : bits < 0x2b800000u ? 0x6a800000u : 0x3f800000u);
}

//// errorPart
// erf(x) / x - 1 of z = x^2, for |x| < 1/2.
float sk_erf_near_0(float z) {
  float p = 4.719082567e-3;
  p = p * z - 2.675773274e-2;
  p = p * z + 1.1282831428e-1;
  p = p * z - 3.7612609007e-1;
  return p * z + 1.2837916560e-1;
}
// erfc(a) for 1/2 <= a <= 10.1: exp(-a^2) times a polynomial of a, or from 2 on, of 1 / a^2, divided by a. exp(-a^2) is that of the
// square of the upper bits of a, which is exact, and of what this lacks. The largest part is added last.
float sk_erfc_part(float a) {
  float p, most, rest;
  if (a < 2.0) {
    float u = a - 1.25;
    p = 6.31804364e-05;
    p = p * u - 0.00019245011;
    p = p * u + 0.000468691283;
    p = p * u - 0.00130869777;
    p = p * u + 0.00355442579;
    p = p * u - 0.00908588948;
    p = p * u + 0.0220112312;
    p = p * u - 0.0502178434;
    p = p * u + 0.106795575;
    p = p * u - 0.208821888;
    most = 0.367822916;
    rest = p * u;
  } else {
    float s = 1.0 / a, z = s * s;
    p = 27.3203039;
    p = p * z - 37.8468554;
    p = p * z + 24.1344601;
    p = p * z - 9.87072363;
    p = p * z + 3.20260697;
    p = p * z - 1.03358131;
    p = p * z + 0.422444945;
    p = p * z - 0.282084682;
    p = p * z + 0.06418953;
    most = 0.5 * s;
    rest = s * p;
  }
  float h = sk_cut(a);
  float square = h * h;
  float n = roundEven(square * -1.44269504);
  sk_precise float b = sk_keep(-square - n * 0.693359375);
  float r = b + (n * 2.12194440e-4 - (a - h) * (a + h));
  float e = 1.9875691500e-4;
  e = e * r + 1.3981999507e-3;
  e = e * r + 8.3334519073e-3;
  e = e * r + 4.1665795894e-2;
  e = e * r + 1.6666665459e-1;
  e = e * r + 5.0000001201e-1;
  return sk_scale(most + (rest + (most + rest) * (r + r * r * e)), int(n));
}
