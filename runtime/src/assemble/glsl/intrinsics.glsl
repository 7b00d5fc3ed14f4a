// SPDX-License-Identifier: MIT
//
// Intrinsics of one float. Each is within 3 ulp and has the special cases of C.
// A section begins with `////` and its name in C++; glsl_text/intrinsics.hpp defines it as a constant.

//// sin
float sk_sin(float x) { return sk_toggle_sign(sk_wave(abs(x), 0), x); }

//// cos
float sk_cos(float x) { return sk_wave(abs(x), 1); }

//// tan
float sk_tan(float x) {
  float a = abs(x);
  if (!(a < uintBitsToFloat(0x7f800000u))) return uintBitsToFloat(0x7fc00000u);
  int q;
  float r = sk_reduce(a, q);
  float z = r * r;
  float p = 9.38540185543e-3;
  p = p * z + 3.11992232697e-3;
  p = p * z + 2.44301354525e-2;
  p = p * z + 5.34112807005e-2;
  p = p * z + 1.33387994085e-1;
  p = p * z + 3.33331568548e-1;
  float t = r + r * (z * p);
  return sk_toggle_sign((q & 1) == 0 ? t : -1.0 / t, x);
}

//// asin
float sk_asin(float x) {
  float a = abs(x);
  if (!(a <= 1.0)) return uintBitsToFloat(0x7fc00000u);
  bool outer = a > 0.5;
  float z = outer ? 0.5 - 0.5 * a : a * a;
  float b = outer ? sqrt(z) : a;
  // what a device's root lacks, by the part of it whose square is exact
  float h = uintBitsToFloat(floatBitsToUint(b) & 0xfffff000u);
  if (outer) b = h + (z - h * h) / (b + h + 1e-30);
  float part = sk_asin_part(b, z);
  float y = outer ? 1.57079637 - (2.0 * b + (2.0 * part + 4.371139e-8)) : b + part;
  return sk_toggle_sign(y, x);
}

//// acos
float sk_acos(float x) {
  float a = abs(x);
  if (!(a <= 1.0)) return uintBitsToFloat(0x7fc00000u);
  bool outer = a > 0.5;
  float z = outer ? 0.5 - 0.5 * a : a * a;
  float b = outer ? sqrt(z) : x;
  float part = sk_asin_part(b, z);
  if (!outer) return 1.57079637 - (b + (part + 4.371139e-8));
  float y = 2.0 * (b + part);
  return x < 0.0 ? 3.14159274 - (y + 8.742278e-8) : y;
}

//// atan
float sk_atan(float x) {
  float a = abs(x);
  float part = sk_atan_part(a > 1.0 ? 1.0 / a : a);
  return sk_toggle_sign(a > 1.0 ? 1.57079637 - (part + 4.371139e-8) : part, x);
}

//// atan2
float sk_atan2(float y, float x) {
  uint a = floatBitsToUint(x) & 0x7fffffffu;
  uint b = floatBitsToUint(y) & 0x7fffffffu;
  if (a > 0x7f800000u || b > 0x7f800000u) return uintBitsToFloat(0x7fc00000u);
  uint most = max(a, b), least = min(a, b);
  bool areDenormal = most < 0x00800000u;   // multiples of 2^-149
  float larger = areDenormal ? float(most) : uintBitsToFloat(most);
  float smaller = areDenormal ? float(least) : uintBitsToFloat(least);
  float scale = larger > 1e30 ? 9.094947e-13 : 1.0;   // 2^-40: some devices divide by way of the reciprocal
  float t = (smaller * scale) / (larger * scale);
  t = a == b ? (a == 0u ? 0.0 : 1.0) : t;
  float angle = sk_atan_part(t);
  angle = b > a ? 1.57079637 - (angle + 4.371139e-8) : angle;
  angle = floatBitsToInt(x) < 0 ? 3.14159274 - (angle + 8.742278e-8) : angle;
  return sk_toggle_sign(angle, y);
}

//// sinh
float sk_sinh(float x) {
  float a = abs(x);
  float z = a * a;
  float p = 2.03721912945e-4;
  p = p * z + 8.33028376239e-3;
  p = p * z + 1.66667160211e-1;
  float e = sk_exp_scaled(a, -1);
  float y = a > 100.0 ? uintBitsToFloat(0x7f800000u) : e - 0.25 / e;
  return sk_toggle_sign(a < 1.0 ? a + a * (z * p) : y, x);
}

//// cosh
float sk_cosh(float x) {
  float a = abs(x);
  float e = sk_exp_scaled(a, -1);
  return a > 100.0 ? uintBitsToFloat(0x7f800000u) : e + 0.25 / e;
}

//// tanh
float sk_tanh(float x) {
  float a = abs(x);
  float z = a * a;
  float p = -5.70498872745e-3;
  p = p * z + 2.06390887954e-2;
  p = p * z - 5.37397155531e-2;
  p = p * z + 1.33314422036e-1;
  p = p * z - 3.33332819422e-1;
  float e = sk_exp_scaled(2.0 * a, 0);
  float y = a > 10.0 ? 1.0 : 1.0 - 2.0 / (e + 1.0);
  return sk_toggle_sign(a < 0.625 ? a + a * (z * p) : y, x);
}

//// asinh
float sk_asinh(float x) {
  float a = abs(x);
  float z = a * a;
  float p = -1.182018459e-3;
  p = p * z + 6.19388835e-3;
  p = p * z - 1.568352482e-2;
  p = p * z + 2.787090207e-2;
  p = p * z - 4.410435271e-2;
  p = p * z + 7.494327847e-2;
  p = p * z - 1.666646068e-1;
  if (a <= 1.0) return sk_toggle_sign(a + a * (z * p), x);
  bool huge = a > 1e9;
  float y = sk_log(huge ? a : a + sqrt(z + 1.0)) + (huge ? 0.693147181 : 0.0);
  return sk_toggle_sign(y, x);
}

//// acosh
float sk_acosh(float x) {
  float t = x - 1.0;
  float p = 1.7596881071e-3;
  p = p * t - 7.5272886713e-3;
  p = p * t + 2.6454905019e-2;
  p = p * t - 1.1784741703e-1;
  p = p * t + 1.4142135263;
  if (x >= 1.0 && x < 1.5) return sqrt(t) * p;
  bool huge = x > 1e9;
  float y = sk_log(huge ? x : x + sqrt(t * (x + 1.0))) + (huge ? 0.693147181 : 0.0);
  return x < 1.0 ? uintBitsToFloat(0x7fc00000u) : y;
}

//// atanh
float sk_atanh(float x) {
  float a = abs(x);
  if (!(a <= 1.0)) return uintBitsToFloat(0x7fc00000u);   // quotients of numbers so large are not the same everywhere
  float z = a * a;
  float p = 1.81740078349e-1;
  p = p * z + 8.24370301058e-2;
  p = p * z + 1.46691431730e-1;
  p = p * z + 1.99782164500e-1;
  p = p * z + 3.33337300303e-1;
  if (a < 0.5) return sk_toggle_sign(a + a * (z * p), x);
  return sk_toggle_sign(0.5 * sk_log((1.0 + a) / (1.0 - a)), x);
}

//// exp
float sk_exp(float x) {
  float y = sk_exp_scaled(x, 0);
  return x > 90.0 ? uintBitsToFloat(0x7f800000u) : x < -104.0 ? 0.0 : y;
}

//// exp2
float sk_exp2(float x) {
  float n = roundEven(x);
  float y = sk_scale(sk_exp2_part(x - n), int(n));
  return x >= 128.0 ? uintBitsToFloat(0x7f800000u) : x < -150.0 ? 0.0 : y;
}

//// log2
float sk_log2(float x) {
  uint bits = floatBitsToUint(x);
  int e;
  float f = sk_mantissa(bits, e) - 1.0;
  float tail = sk_log_tail(f) - 0.5 * (f * f);
  float y = tail * 0.44269504 + f * 0.44269504 + tail + f + float(e);
  return bits - 1u < 0x7f7fffffu ? y : sk_log_limit(x);
}

//// log10
float sk_log10(float x) {
  uint bits = floatBitsToUint(x);
  int e;
  float f = sk_mantissa(bits, e) - 1.0;
  float n = float(e);
  float tail = sk_log_tail(f) - 0.5 * (f * f);
  float y = (f + tail) * 7.00731903e-4 + n * 2.48745664e-4 + tail * 0.43359375 + f * 0.43359375 + n * 0.30078125;
  return bits - 1u < 0x7f7fffffu ? y : sk_log_limit(x);
}

//// hypot
float sk_hypot(float x, float y) {
  uint a = floatBitsToUint(x) & 0x7fffffffu, b = floatBitsToUint(y) & 0x7fffffffu;
  float scale = sk_length_scale(max(a, b));
  float v = x * scale, w = y * scale;
  float h = sqrt(v * v + w * w) * uintBitsToFloat(0x7f000000u - floatBitsToUint(scale));
  return a == 0x7f800000u || b == 0x7f800000u ? uintBitsToFloat(0x7f800000u) : h;
}

//// log1p
// The logarithm of u = 1 + x, and what u was rounded by.
float sk_log1p(float x) {
  sk_precise float u = sk_keep(1.0 + x);
  sk_precise float v = sk_keep(u - 1.0);
  sk_precise float lost = sk_keep(x - v);
  uint bits = floatBitsToUint(u);
  int e;
  float f = sk_mantissa(bits, e) - 1.0;
  float n = float(e);
  f = e == 0 ? x : f;
  float tail = sk_log_tail(f) - 0.5 * (f * f);
  float y = (f + (tail + (lost / u - n * 2.12194440e-4))) + n * 0.693359375;
  return bits - 1u < 0x7f7fffffu ? (e == 0 ? f + tail : y) : sk_log_limit(u);
}

//// expm1
float sk_expm1(float x) {
  if (x == 0.0) return x;
  float n = roundEven(clamp(x, -30.0, 30.0) * 1.44269504);
  sk_precise float a = sk_keep(x - n * 0.693359375);
  sk_precise float r = sk_keep(a + n * 2.12194440e-4);
  float p = 1.989128e-4;
  p = p * r + 1.393391e-3;
  p = p * r + 8.33331066e-3;
  p = p * r + 4.16664626e-2;
  p = p * r + 1.66666667e-1;
  p = p * r + 5.0000000137e-1;
  float t = intBitsToFloat((int(n) + 127) << 23);
  sk_precise float fraction = sk_keep(r + r * r * p);   // not a part of t * (fraction + 1)
  sk_precise float whole = sk_keep(t - 1.0);
  float y = n == 0.0 ? fraction : t * fraction + whole;
  float large = x > 90.0 ? uintBitsToFloat(0x7f800000u) : sk_exp_scaled(x, 0);
  return x > 30.0 ? large : x < -30.0 ? -1.0 : y;
}

//// cbrt
// |x| is m * 8^(k - 42) with 1/2 <= m < 4. A third of the bits of m, as a number, are nearly those of its root; then come a step of
// Halley's method and one of Newton's.
float sk_cbrt(float x) {
  uint bits = floatBitsToUint(x) & 0x7fffffffu;
  if (bits - 1u >= 0x7f7fffffu) return x;
  bool below = bits < 0x00800000u;   // a multiple of 2^-149, whose double is one of 2^-150
  if (below) bits = floatBitsToUint(2.0 * float(bits));
  uint e = bits >> 23, k = e / 3u;
  float m = uintBitsToFloat((bits & 0x7fffffu) | ((e - 3u * k + 126u) << 23));
  float y = uintBitsToFloat(floatBitsToUint(m) / 3u + 0x2a514067u);
  float cube = y * y * y;
  y = y * ((cube + 2.0 * m) / (2.0 * cube + m));
  y = y - (y * y * y - m) / (3.0 * (y * y));
  return sk_with_sign(y * uintBitsToFloat((k + (below ? 35u : 85u)) << 23), x);
}

//// erf
float sk_erf(float x) {
  float a = abs(x);
  float small = a < 1e-30 ? a * 1.12837917 : a + a * sk_erf_near_0(a * a);   // without a denormal number
  float y = a > 4.0 ? 1.0 : 1.0 - sk_erfc_part(clamp(a, 0.5, 4.0));
  if ((floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u) return x;
  return sk_with_sign(a < 0.5 ? small : y, x);
}

//// erfc
float sk_erfc(float x) {
  float a = abs(x);
  float more = x * sk_erf_near_0(x * x);
  float small = a < 0.25 ? 1.0 - (x + more) : 0.5 - ((x - 0.5) + more);
  float tail = sk_erfc_part(clamp(a, 0.5, 10.1));
  float y = x < 0.0 ? 2.0 - tail : a > 10.1 ? 0.0 : tail;
  if ((floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u) return x;
  return a < 0.5 ? small : y;
}

//// pow
float sk_pow(float x, float y) {
  uint bits = floatBitsToUint(x);
  uint a = bits & 0x7fffffffu;
  uint b = floatBitsToUint(y) & 0x7fffffffu;
  if (b == 0u || bits == 0x3f800000u) return 1.0;
  if (a > 0x7f800000u || b > 0x7f800000u) return uintBitsToFloat(0x7fc00000u);
  bool whole = floor(y) == y;
  bool odd = whole && floor(0.5 * y) != 0.5 * y;
  bool below = floatBitsToInt(y) < 0;
  float p = sk_power(a, clamp(y, -1.0995116e12, 1.0995116e12));
  if (a == 0u) p = uintBitsToFloat(below ? 0x7f800000u : 0u);
  if (a == 0x7f800000u) p = uintBitsToFloat(below ? 0u : 0x7f800000u);
  if (a == 0x3f800000u) p = 1.0;
  bool negative = floatBitsToInt(x) < 0;
  if (negative && !whole && a != 0u && a != 0x7f800000u) return uintBitsToFloat(0x7fc00000u);
  return negative && odd ? -p : p;
}

//// clamp
float sk_clamp(float x, float low, float high) { return sk_min(sk_max(x, low), high); }

//// fract
float sk_fract(float x) {
  float f = x - floor(x);
  return f >= 1.0 ? 0.99999994 : f;
}

//// mod
// x * 2^64, also where x is denormal.
float sk_raised(float x) {
  uint bits = floatBitsToUint(x), m = bits & 0x7fffffffu;
  return m < 0x800000u ? sk_with_sign(float(m) * 2.5849394e-26, x) : x * 1.8446744e19;
}
float sk_mod(float x, float y) {
  float r = sk_fmod(x, y);
  int bits = floatBitsToInt(r), of_y = floatBitsToInt(y);
  if ((bits & 0x7fffffff) == 0 || (bits ^ of_y) >= 0) return r;
  if ((of_y & 0x7fffffff) >= 0x20000000) return r + y;
  float s = sk_raised(r) + sk_raised(y);   // many devices take denormal numbers as 0
  if (abs(s) < 2.1684043e-19) return sk_with_sign(intBitsToFloat(int(abs(s) * 3.8685626e25)), y);
  return s * 5.4210109e-20;
}

//// mix
float sk_mix(float x, float y, float t) {
  sk_precise float a = sk_keep(x * (1.0 - t));
  sk_precise float b = sk_keep(y * t);
  return t == 0.0 ? x : t == 1.0 ? y : a + b;
}

//// step
float sk_step(float edge, float x) { return x < edge ? 0.0 : 1.0; }

//// smoothstep
float sk_smoothstep(float low, float high, float x) {
  float t = sk_saturate((x - low) / (high - low));
  return t * t * (3.0 - 2.0 * t);
}

//// sign
// By the bits: some compilers negate the 0 of a choice between 0 and -1.
float sk_sign(float x) {
  uint bits = floatBitsToUint(x);
  return uintBitsToFloat((bits & 0x7fffffffu) - 1u < 0x7f800000u ? (bits & 0x80000000u) | 0x3f800000u : 0u);
}

//// isnan
bool sk_isnan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }

//// isinf
bool sk_isinf(float x) { return (floatBitsToUint(x) & 0x7fffffffu) == 0x7f800000u; }
