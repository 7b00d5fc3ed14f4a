// SPDX-License-Identifier: MIT
//
// Doubles in two representations: GLSL's own, and pairs of floats.
//
// A native double is stored as its bits, and is a double only within these functions, which costs nothing.
// NVIDIA's GLSL compiler (seen on an H100, at every version) rounds doubles to floats in arrays with a
// computed index, alone or in structs.
//
// A pair is the sum of two floats, the second at most half a unit in the last place of the first: 48 bits of
// precision in the range of float. Its arithmetic consists of error-free steps, which compilers must not
// change (own_arithmetic.hpp).
//
//   sum, product    Joldes, Muller, Popescu, ACM TOMS 44 (2017): algorithms 6 and 10
//   product's error Dekker, Numerische Mathematik 18 (1971), splitting into 12 bits with a mask: no fma,
//                   which need not be fused, and no overflow
//   quotient, root  long division: the remainder is divided again, so that the device's own
//                   division and root may be off by some units in the last place
//
// A section begins with `////` and its name in C++; glsl_text/doubles.hpp defines it as a constant.

//// native
struct sk_double { uvec2 bits; };
sk_double sk_choose(bool c, sk_double a, sk_double b) { return sk_double(c ? a.bits : b.bits); }
double sk_value(sk_double a) { return packDouble2x32(a.bits); }
sk_double sk_of(double a) { return sk_double(unpackDouble2x32(a)); }
sk_double sk_unpack(uvec2 b) { return sk_double(b); }
uvec2 sk_pack(sk_double a) { return a.bits; }
sk_double sk_to_double(float a) { return sk_of(double(a)); }
sk_double sk_to_double(int a) { return sk_of(double(a)); }
sk_double sk_to_double(uint a) { return sk_of(double(a)); }
float sk_to_float(sk_double a) { return float(sk_value(a)); }
bool sk_isnan(sk_double a) {
  uint high = a.bits.y & 0x7fffffffu;
  return high > 0x7ff00000u || (high == 0x7ff00000u && a.bits.x != 0u);
}
int sk_to_int(sk_double a) {
  if (sk_isnan(a)) return 0;   // comparisons of NaN are not the same everywhere
  double x = sk_value(a);
  if (x >= 2147483648.0lf) return 2147483647;
  return x > -2147483648.0lf ? int(x) : x <= -2147483648.0lf ? -2147483647 - 1 : 0;
}
uint sk_to_uint(sk_double a) {
  if (sk_isnan(a)) return 0u;
  double x = sk_value(a);
  return x >= 4294967296.0lf ? 0xffffffffu : x > 0.0lf ? uint(x) : 0u;
}
sk_double sk_neg(sk_double a) { return sk_double(a.bits ^ uvec2(0u, 0x80000000u)); }
bool sk_is_negative(sk_double a) { return int(a.bits.y) < 0; }
// A zero with the sign of a.
sk_double sk_zero_of(sk_double a) { return sk_double(uvec2(0u, a.bits.y & 0x80000000u)); }
sk_double sk_add(sk_double a, sk_double b) { sk_written double r = sk_value(a) + sk_value(b); return sk_of(r); }
sk_double sk_sub(sk_double a, sk_double b) { sk_written double r = sk_value(a) - sk_value(b); return sk_of(r); }
sk_double sk_mul(sk_double a, sk_double b) { sk_written double r = sk_value(a) * sk_value(b); return sk_of(r); }
sk_double sk_div(sk_double a, sk_double b) { sk_written double r = sk_value(a) / sk_value(b); return sk_of(r); }
bool sk_less(sk_double a, sk_double b) { return sk_value(a) < sk_value(b); }
bool sk_less_equal(sk_double a, sk_double b) { return sk_value(a) <= sk_value(b); }
bool sk_equal(sk_double a, sk_double b) { return sk_value(a) == sk_value(b); }
// The order of minima and maxima, in which -0 is below 0.
bool sk_precedes(sk_double a, sk_double b) { return sk_less(a, b) || (sk_equal(a, b) && sk_is_negative(a)); }
sk_double sk_abs(sk_double a) { return sk_double(a.bits & uvec2(0xffffffffu, 0x7fffffffu)); }
// From 2^52 on, all are whole. Of infinity, Mesa's functions are NaN.
bool sk_is_whole(sk_double a) { return (a.bits.y & 0x7fffffffu) >= 0x43300000u; }
// r with the sign of a: Mesa's functions lose that of a zero.
sk_double sk_signed(double r, sk_double a) {
  uvec2 b = unpackDouble2x32(r);
  return sk_double(uvec2(b.x, (b.y & 0x7fffffffu) | (a.bits.y & 0x80000000u)));
}
sk_double sk_floor(sk_double a) { return sk_is_whole(a) ? a : sk_signed(floor(sk_value(a)), a); }
sk_double sk_trunc(sk_double a) { return sk_is_whole(a) ? a : sk_signed(trunc(sk_value(a)), a); }
sk_double sk_round(sk_double a) { return sk_is_whole(a) ? a : sk_signed(roundEven(sk_value(a)), a); }
sk_double sk_sqrt(sk_double a) { return sk_of(sqrt(sk_value(a))); }
bool sk_isinf(sk_double a) { return sk_abs(a).bits == uvec2(0u, 0x7ff00000u); }
// What is below the smallest normal double is 0.
sk_double sk_ldexp(sk_double a, int e) {
  uint sign = a.bits.y & 0x80000000u;
  int old = int((a.bits.y >> 20) & 0x7ffu);
  int scaled = old + clamp(e, -4096, 4096);
  if (old == 2047) return a;
  if (old == 0 || scaled <= 0) return sk_double(uvec2(0u, sign));
  if (scaled >= 2047) return sk_double(uvec2(0u, sign | 0x7ff00000u));
  return sk_double(uvec2(a.bits.x, (a.bits.y & 0x800fffffu) | (uint(scaled) << 20)));
}

// The power of 2 by which to divide numbers, of which this is the largest magnitude, so that no square overflows and none that
// counts underflows.
int sk_square_exponent(sk_double a) {
  int e = int((a.bits.y >> 20) & 0x7ffu) - 1023;
  return abs(e) < 400 || e == 1024 || e == -1023 ? 0 : e;
}

//// pair
struct sk_double { float hi, lo; };

sk_double sk_choose(bool c, sk_double a, sk_double b) { return sk_double(c ? a.hi : b.hi, c ? a.lo : b.lo); }

bool sk_is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }

// The sum of two floats, for |a| >= |b| or a = 0.
sk_double sk_join(float a, float b) {
  sk_precise float s = sk_keep(a + b);
  sk_precise float t = sk_keep(s - a);
  sk_precise float e = sk_keep(b - t);
  bool isOne = b == 0.0;   // keeps the sign of a zero
  return sk_double(isOne ? a : s, isOne || !sk_is_finite(s) ? 0.0 : e);
}

// The result, unless its head is infinite or NaN. Without branches, which take compilers long.
sk_double sk_where_finite(float head, sk_double result) {
  bool isFinite = sk_is_finite(head);
  return sk_double(isFinite ? result.hi : head, isFinite ? result.lo : 0.0);
}

// The sum of any two floats; what is lost is not finite where the sum is not.
sk_double sk_two_sum(float a, float b) {
  sk_precise float s = sk_keep(a + b);
  bool isLarge = abs(a) >= abs(b);
  sk_precise float t = sk_keep(s - (isLarge ? a : b));
  sk_precise float e = sk_keep((isLarge ? b : a) - t);
  return sk_double(s, e);
}

// The product of two floats, and what it lacks. The power of 2 in a goes to b before they are split, so that only a small product
// has small parts, however far apart the factors are: those of a are 2^-23 at least, those of b and their products as large
// as the product of the mantissas' units, which is normal for products from 2^-78 on. Below, up to 2^-123 is lost; from 2^-99 on down,
// that is more than the rounded product lacks, which then stands alone. What is lost is anything where the product is not finite.
sk_double sk_two_product(float a, float b) {
  sk_precise float p = sk_keep(a * b);
  float m = uintBitsToFloat((floatBitsToUint(a) & 0x807fffffu) | 0x3f800000u);
  float n = b * uintBitsToFloat(floatBitsToUint(a) & 0x7f800000u);
  float ah = uintBitsToFloat(floatBitsToUint(m) & 0xfffff000u);
  float bh = uintBitsToFloat(floatBitsToUint(n) & 0xfffff000u);
  sk_precise float al = sk_keep(m - ah);
  sk_precise float bl = sk_keep(n - bh);
  sk_precise float d = sk_keep(ah * bh - p);   // products of halves are exact, contracted or not
  sk_precise float e = sk_keep(d + ah * bl);
  sk_precise float f = sk_keep(e + al * bh);
  sk_precise float g = sk_keep(f + al * bl);
  return sk_double(p, abs(p) < 1.5777218104420236e-30 ? 0.0 : g);
}

sk_double sk_neg(sk_double a) { return sk_double(-a.hi, -a.lo); }
bool sk_is_negative(sk_double a) { return floatBitsToInt(a.hi) < 0; }
// NVIDIA's compiler for ES takes the constants -0.0 and 0.0 of a ?: for one, so the zero is made from bits.
sk_double sk_zero_of(sk_double a) {
  float zero = uintBitsToFloat(floatBitsToUint(a.hi) & 0x80000000u);
  return sk_double(zero, zero);
}

sk_double sk_add(sk_double a, sk_double b) {
  sk_double s = sk_two_sum(a.hi, b.hi);
  sk_double t = sk_two_sum(a.lo, b.lo);
  sk_precise float c = sk_keep(s.lo + t.hi);
  sk_double v = sk_join(s.hi, c);
  sk_precise float w = sk_keep(t.lo + v.lo);
  return sk_where_finite(s.hi, sk_join(v.hi, w));
}

sk_double sk_sub(sk_double a, sk_double b) { return sk_add(a, sk_neg(b)); }

sk_double sk_mul(sk_double a, sk_double b) {
  sk_double p = sk_two_product(a.hi, b.hi);
  sk_precise float c = sk_keep(a.hi * b.lo);
  sk_precise float d = sk_keep(a.lo * b.hi);
  sk_precise float e = sk_keep(c + d);
  sk_precise float f = sk_keep(p.lo + e);
  return sk_where_finite(p.hi, sk_join(p.hi, f));
}

sk_double sk_div(sk_double a, sk_double b) {
  uint size = floatBitsToUint(a.hi) & 0x7fffffffu;
  bool isSmall = size < 0x20000000u;    // what is left may be denormal: of 2^64 a then
  bool isLarge = size >= 0x7e000000u;   // a quotient that is not rounded to the nearest times b may overflow: of a / 4 then
  float scale = isLarge ? 0.25 : 1.0, back = isLarge ? 4.0 : 1.0;
  scale = isSmall ? 18446744073709551616.0 : scale;
  back = isSmall ? 5.421010862427522e-20 : back;
  a = sk_double(a.hi * scale, a.lo * scale);
  sk_precise float q = sk_keep(a.hi / b.hi);
  sk_double left = sk_sub(a, sk_mul(b, sk_double(q, 0.0)));
  sk_precise float r = sk_keep(left.hi / b.hi);
  left = sk_sub(left, sk_mul(b, sk_double(r, 0.0)));
  sk_precise float s = sk_keep(left.hi / b.hi);
  sk_double sum = sk_join(q, r);
  sk_precise float t = sk_keep(sum.lo + s);
  sum = sk_join(sum.hi, t);
  bool isHead = q == 0.0 || !sk_is_finite(q) || !sk_is_finite(b.hi);
  float hi = (isHead ? q : sum.hi) * back;
  return sk_double(hi, isHead || !sk_is_finite(hi) ? 0.0 : sum.lo * back);
}

sk_double sk_sqrt(sk_double a) {
  bool isSmall = (floatBitsToUint(a.hi) & 0x7fffffffu) < 0x20000000u;   // what is left may be denormal: of 2^64 a then
  float scale = isSmall ? 18446744073709551616.0 : 1.0, back = isSmall ? 2.3283064365386963e-10 : 1.0;
  if (a.hi > 8.5070591730234616e37 && sk_is_finite(a.hi)) {   // the square of a root that is rounded up may overflow: of a / 4 then
    scale = 0.25;
    back = 2.0;
  }
  a = sk_double(a.hi * scale, a.lo * scale);
  sk_precise float s = sk_keep(sqrt(a.hi));
  sk_double left = sk_sub(a, sk_two_product(s, s));
  sk_precise float t = sk_keep(0.5 * left.hi / s);
  sk_double root = sk_join(s, t);
  left = sk_sub(a, sk_mul(root, root));
  sk_precise float u = sk_keep(0.5 * left.hi / s);
  root = sk_add(root, sk_double(u, 0.0));
  bool isHead = s == 0.0 || !sk_is_finite(s);
  return sk_double((isHead ? s : root.hi) * back, isHead ? 0.0 : root.lo * back);
}

bool sk_less(sk_double a, sk_double b) { return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo); }
bool sk_less_equal(sk_double a, sk_double b) { return a.hi < b.hi || (a.hi == b.hi && a.lo <= b.lo); }
bool sk_equal(sk_double a, sk_double b) { return a.hi == b.hi && a.lo == b.lo; }

bool sk_isnan(sk_double a) { return (floatBitsToUint(a.hi) & 0x7fffffffu) > 0x7f800000u; }
bool sk_isinf(sk_double a) { return (floatBitsToUint(a.hi) & 0x7fffffffu) == 0x7f800000u; }

// The order of minima and maxima, in which -0 is below 0. By the bits, since a device may take denormal numbers as 0.
int sk_rank(float x) {
  int bits = floatBitsToInt(x);
  return bits ^ ((bits >> 31) & 0x7fffffff);
}
bool sk_precedes(sk_double a, sk_double b) {
  int x = sk_rank(a.hi), y = sk_rank(b.hi);
  return (x < y || (x == y && sk_rank(a.lo) < sk_rank(b.lo))) && !sk_isnan(a) && !sk_isnan(b);
}

sk_double sk_abs(sk_double a) { return sk_choose(floatBitsToUint(a.hi) >> 31 != 0u, sk_neg(a), a); }

sk_double sk_floor(sk_double a) {
  float f = floor(a.hi);
  return sk_choose(f == a.hi, sk_join(f, floor(a.lo)), sk_double(f, 0.0));
}

sk_double sk_trunc(sk_double a) { return sk_choose(a.hi < 0.0, sk_neg(sk_floor(sk_neg(a))), sk_floor(a)); }

// To the nearest integer; of two, to the even one.
sk_double sk_round(sk_double a) {
  float r = roundEven(a.hi);
  if (r == a.hi) {
    float s = roundEven(a.lo);
    if (abs(a.lo) == 0.5 && fract(0.5 * r) != 0.0) s = a.lo < 0.0 ? -1.0 : 1.0;
    return sk_join(r, s);
  }
  bool between = abs(a.hi - r) == 0.5 && a.lo != 0.0;
  return sk_double(!between ? r : a.lo < 0.0 ? floor(a.hi) : ceil(a.hi), 0.0);
}

// ---- IEEE 754's doubles, and integers -------------------------------------------------------------

sk_double sk_unpack(uvec2 b) {
  uint sign = b.y & 0x80000000u;
  int e = int((b.y >> 20) & 0x7ffu) - 1023;
  bool isNan = e == 1024 && ((b.y & 0xfffffu) | b.x) != 0u;
  if (isNan) return sk_double(uintBitsToFloat(sign | 0x7fc00000u), 0.0);
  if (e > 127) return sk_double(uintBitsToFloat(sign | 0x7f800000u), 0.0);
  if (e < -126) return sk_double(uintBitsToFloat(sign), 0.0);
  uint m = ((b.y & 0xfffffu) << 3) | (b.x >> 29);
  int left = int(b.x & 0x1fffffffu);   // in units of 2^(e - 52)
  if (left > 0x10000000 || (left == 0x10000000 && (m & 1u) != 0u)) {
    left -= 0x20000000;
    m += 1u;
  }
  uint hi = (uint(e + 127) << 23) + m;
  if (hi >= 0x7f800000u) return sk_double(uintBitsToFloat(sign | 0x7f800000u), 0.0);
  uint l = floatBitsToUint(float(left));
  int f = int((l >> 23) & 0xffu) + e - 52;
  uint lo = left == 0 || f <= 0 ? 0u : (l & 0x807fffffu) | (uint(f) << 23);
  return sk_double(uintBitsToFloat(hi | sign), uintBitsToFloat(lo ^ sign));
}

// The nearest double to the pair's sum; of two, the even one.
uvec2 sk_pack(sk_double a) {
  uint h = floatBitsToUint(a.hi);
  uint l = floatBitsToUint(a.lo);
  uint sign = h & 0x80000000u;
  uint m = h & 0x7fffffu;
  int e = int((h >> 23) & 0xffu);
  int f = int((l >> 23) & 0xffu);
  if (e == 255) return uvec2(0u, sign | (m != 0u ? 0x7ff80000u : 0x7ff00000u));
  if (e == 0) return uvec2(0u, sign);
  bool isLess = f != 0 && (l & 0x80000000u) != sign;
  int k = isLess && m == 0u ? 1 : 0;   // below a power of 2, units are half as large
  int g = f + 179 + k - e;             // of the tail in units of the double's last place
  uint tail = f == 0 || g <= 0 ? 0u : uint(roundEven(uintBitsToFloat((uint(g) << 23) | (l & 0x7fffffu))));
  uvec2 sum = uvec2((m << 29) << k, ((m | 0x800000u) >> 3) << k);
  uint low = isLess ? sum.x - tail : sum.x + tail;
  uint high = isLess ? sum.y - (tail > sum.x ? 1u : 0u) : sum.y + (low < tail ? 1u : 0u);
  return uvec2(low, sign | ((uint(e - k + 896) << 20) + (high - 0x100000u)));
}

sk_double sk_to_double(float a) { return sk_double(a, 0.0); }
sk_double sk_to_double(int a) { return sk_join(float(a >> 16) * 65536.0, float(a & 0xffff)); }
sk_double sk_to_double(uint a) { return sk_join(float(a >> 16) * 65536.0, float(a & 0xffffu)); }
float sk_to_float(sk_double a) { return a.hi; }

uint sk_to_uint(sk_double a) {
  if (sk_isnan(a) || a.hi <= 0.0) return 0u;
  uvec2 b = sk_pack(a);
  uint m = (b.y & 0xfffffu) | 0x100000u;
  int e = int((b.y >> 20) & 0x7ffu) - 1023;
  if (e < 0) return 0u;
  if (e > 31) return 0xffffffffu;
  return e <= 20 ? m >> (20 - e) : (m << (e - 20)) | (b.x >> (52 - e));
}

int sk_to_int(sk_double a) {
  uint n = sk_to_uint(sk_abs(a));
  if (a.hi < 0.0) return n >= 0x80000000u ? -2147483647 - 1 : -int(n);
  return int(min(n, 0x7fffffffu));
}

// Of the bits, since a device may reorder products of which some are too large. What is below the smallest normal
// float is 0.
float sk_scaled(float a, int e) {
  uint b = floatBitsToUint(a);
  uint sign = b & 0x80000000u;
  int old = int((b >> 23) & 0xffu);
  int scaled = old + clamp(e, -1024, 1024);
  if (old == 255) return a;
  if (old == 0 || scaled <= 0) return uintBitsToFloat(sign);
  return uintBitsToFloat(scaled >= 255 ? sign | 0x7f800000u : (b & 0x807fffffu) | (uint(scaled) << 23));
}
sk_double sk_ldexp(sk_double a, int e) {
  float hi = sk_scaled(a.hi, e);
  return sk_double(hi, sk_is_finite(hi) ? sk_scaled(a.lo, e) : 0.0);
}


// The power of 2 by which to divide numbers, of which this is the largest magnitude, so that the squares neither overflow nor
// lose their second float.
int sk_square_exponent(sk_double a) {
  int e = int((floatBitsToUint(a.hi) >> 23) & 0xffu) - 127;
  return abs(e) < 24 || e == 128 || e == -127 ? 0 : e;
}

//// common
// A zero with the sign of a; any other number itself.
sk_double sk_zero_like(sk_double r, sk_double a) {
  return sk_choose(sk_equal(r, sk_to_double(0.0)), sk_zero_of(a), r);
}

// The float nearest to a double of these bits, of two the even one: also a denormal one, which a device may take as 0.
float sk_nearest_float(uvec2 b) {
  uint sign = b.y & 0x80000000u;
  int e = int((b.y >> 20) & 0x7ffu) - 1023;
  bool isNan = e == 1024 && ((b.y & 0xfffffu) | b.x) != 0u;
  if (e > 127) return uintBitsToFloat(sign | (isNan ? 0x7fc00000u : 0x7f800000u));
  if (e < -150) return uintBitsToFloat(sign);
  uint m = (((b.y & 0xfffffu) | 0x100000u) << 8) | (b.x >> 24);   // 29 bits; the other 24 only break ties
  int places = 5 + max(-126 - e, 0);
  uint bits = (uint(max(e + 126, 0)) << 23) + (m >> places), half_ = 1u << (places - 1), rest = m & (half_ + half_ - 1u);
  bool isUp = rest > half_ || (rest == half_ && ((bits & 1u) | (b.x & 0xffffffu)) != 0u);
  return uintBitsToFloat(sign | (isUp ? bits + 1u : bits));
}
vec2 sk_nearest_float(uvec4 b) { return vec2(sk_nearest_float(b.xy), sk_nearest_float(b.zw)); }

// A float that rounds to the half that is nearest to the double: the nearest float if that is exact or odd, else its odd neighbour
// on the other side of the double.
float sk_to_odd(sk_double a) {
  float f = sk_to_float(a);
  if (sk_isinf(a) || sk_isnan(a)) return f;
  sk_double rest = sk_sub(a, sk_to_double(f)), zero = sk_to_double(0.0);
  int bits = floatBitsToInt(f);
  bool isAbove = sk_less(zero, rest), isBelow = sk_less(rest, zero);
  if ((bits & 1) != 0 || !(isAbove || isBelow)) return f;
  return intBitsToFloat(isAbove == (bits >= 0) ? bits + 1 : bits - 1);
}

struct sk_double2 { sk_double x, y; };
struct sk_double3 { sk_double x, y, z; };
struct sk_double4 { sk_double x, y, z, w; };
sk_double2 sk_unpack(uvec4 b) { return sk_double2(sk_unpack(b.xy), sk_unpack(b.zw)); }
uvec4 sk_pack(sk_double2 a) { return uvec4(sk_pack(a.x), sk_pack(a.y)); }
