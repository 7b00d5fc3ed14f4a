// SPDX-License-Identifier: MIT
//
// Integers of 64 bits: two words, the lower one first, as streams hold them. GLSL has no such type that all devices know.
//
//   quotient            long division, one bit after the other, unless both operands have one word or the divisor is a small literal
//   nearest float       the 24 upper bits, rounded to even by what is below them: the device's own conversions may round
//                       otherwise, and know 32 bits
//
// A section begins with `////` and its name in C++.

//// integers
struct sk_long { uvec2 bits; };
struct sk_ulong { uvec2 bits; };
struct sk_long2 { sk_long x, y; };
struct sk_long3 { sk_long x, y, z; };
struct sk_long4 { sk_long x, y, z, w; };
struct sk_ulong2 { sk_ulong x, y; };
struct sk_ulong3 { sk_ulong x, y, z; };
struct sk_ulong4 { sk_ulong x, y, z, w; };
sk_long sk_long_of(uvec2 b) { return sk_long(b); }
sk_long2 sk_long_of(uvec4 b) { return sk_long2(sk_long(b.xy), sk_long(b.zw)); }
sk_ulong sk_ulong_of(uvec2 b) { return sk_ulong(b); }
sk_ulong2 sk_ulong_of(uvec4 b) { return sk_ulong2(sk_ulong(b.xy), sk_ulong(b.zw)); }
uvec2 sk_words_of(sk_long a) { return a.bits; }
uvec4 sk_words_of(sk_long2 a) { return uvec4(a.x.bits, a.y.bits); }
uvec2 sk_words_of(sk_ulong a) { return a.bits; }
uvec4 sk_words_of(sk_ulong2 a) { return uvec4(a.x.bits, a.y.bits); }

// Operations on two words, which both types share.
uvec2 sk_sum_of(uvec2 a, uvec2 b) {
  uint low = a.x + b.x;
  return uvec2(low, a.y + b.y + uint(low < a.x));
}
uvec2 sk_opposite(uvec2 a) { return sk_sum_of(~a, uvec2(1u, 0u)); }
uvec2 sk_product_of(uint a, uint b) {
  uint a0 = a & 0xffffu, a1 = a >> 16, b0 = b & 0xffffu, b1 = b >> 16;
  uint middle = a1 * b0 + ((a0 * b0) >> 16);
  uint other = a0 * b1 + (middle & 0xffffu);
  return uvec2(a * b, a1 * b1 + (middle >> 16) + (other >> 16));
}
uvec2 sk_product_of(uvec2 a, uvec2 b) {
  return sk_product_of(a.x, b.x) + uvec2(0u, a.x * b.y + a.y * b.x);
}
// The upper two of the four words of a product.
uvec2 sk_high_product(uvec2 a, uvec2 b) {
  uvec2 low = sk_product_of(a.x, b.x), first = sk_product_of(a.x, b.y), second = sk_product_of(a.y, b.x);
  uvec2 middle = sk_sum_of(first, uvec2(low.y, 0u));
  uvec2 other = sk_sum_of(second, uvec2(middle.x, 0u));
  return sk_sum_of(sk_sum_of(sk_product_of(a.y, b.y), uvec2(middle.y, 0u)), uvec2(other.y, 0u));
}
uvec2 sk_left(uvec2 a, uint n) {
  n &= 63u;
  if (n == 0u) return a;
  return n < 32u ? uvec2(a.x << n, (a.y << n) | (a.x >> (32u - n))) : uvec2(0u, a.x << (n - 32u));
}
// `sign` fills the upper bits.
uvec2 sk_right(uvec2 a, uint n, uint sign) {
  n &= 63u;
  if (n == 0u) return a;
  if (n == 32u) return uvec2(a.y, sign);
  return n < 32u ? uvec2((a.x >> n) | (a.y << (32u - n)), (a.y >> n) | (sign << (32u - n)))
                 : uvec2((a.y >> (n - 32u)) | (sign << (64u - n)), sign);
}
bool sk_below(uvec2 a, uvec2 b) { return a.y < b.y || (a.y == b.y && a.x < b.x); }
uint sk_sign_of(uvec2 a) { return 0u - (a.y >> 31); }
uvec2 sk_magnitude_of(uvec2 a) { return (a.y >> 31) != 0u ? sk_opposite(a) : a; }
// The quotient and the remainder; those by 1 if b is 0. One exit: compilers put what follows each other one into a branch.
uvec4 sk_divided(uvec2 a, uvec2 b) {
  bool isShort = (a.y | b.y) == 0u && b.x != 0u;
  uint word = isShort ? b.x : 1u;
  uvec2 rest = uvec2(isShort ? a.x % word : 0u, 0u);
  if (isShort) a.x /= word;
  int bits = isShort || (b.x | b.y) == 0u ? 0 : 64;
  for (int i = 0; i < bits; ++i) {
    uint carry = rest.y >> 31;
    rest = uvec2((rest.x << 1) | (a.y >> 31), (rest.y << 1) | (rest.x >> 31));
    a = uvec2(a.x << 1, (a.y << 1) | (a.x >> 31));
    uint goes = carry | uint(!sk_below(rest, b));
    rest = sk_sum_of(rest, goes != 0u ? sk_opposite(b) : uvec2(0u));
    a.x |= goes;
  }
  return uvec4(a, rest);
}
// The quotient and the remainder by a divisor below 2^24: bytes of the dividend one after the other, without a loop.
uvec3 sk_divided_by(uvec2 a, uint d) {
  uint high = a.y / d, rest = a.y % d, n = (rest << 8) | (a.x >> 24);
  uint low = n / d;
  n = ((n % d) << 8) | ((a.x >> 16) & 255u);
  low = (low << 8) | (n / d);
  n = ((n % d) << 8) | ((a.x >> 8) & 255u);
  low = (low << 8) | (n / d);
  n = ((n % d) << 8) | (a.x & 255u);
  return uvec3((low << 8) | (n / d), high, n % d);
}
int sk_bits_set(uint n) {
  n -= (n >> 1) & 0x55555555u;
  n = (n & 0x33333333u) + ((n >> 2) & 0x33333333u);
  n = (n + (n >> 4)) & 0x0f0f0f0fu;
  return int((n * 0x01010101u) >> 24);
}
// The zeros in front of the highest bit; 32 of 0.
int sk_zeros_before(uint n) {
  n |= n >> 1;
  n |= n >> 2;
  n |= n >> 4;
  n |= n >> 8;
  return 32 - sk_bits_set(n | (n >> 16));
}
int sk_zeros_before(uvec2 a) { return a.y != 0u ? sk_zeros_before(a.y) : 32 + sk_zeros_before(a.x); }
int sk_zeros_behind(uvec2 a) {
  return a.x != 0u ? sk_bits_set((a.x & (0u - a.x)) - 1u) : 32 + sk_bits_set((a.y & (0u - a.y)) - 1u);
}
// The float nearest to a number without sign.
float sk_nearest_of(uvec2 a) {
  if ((a.x | a.y) == 0u) return 0.0;
  int zeros = sk_zeros_before(a);
  a = sk_left(a, uint(zeros));
  uint whole = a.y >> 8, rest = a.y & 255u;
  bool isUp = rest > 128u || (rest == 128u && (a.x != 0u || (whole & 1u) != 0u));
  return float(whole + uint(isUp)) * uintBitsToFloat(uint(127 + 40 - zeros) << 23);
}
// The magnitude of a float, truncated; all bits from 2^64 on, and 0 of NaN.
uvec2 sk_truncated(float x) {
  uint bits = floatBitsToUint(x) & 0x7fffffffu;
  int exponent = int(bits >> 23) - 127;
  if (bits > 0x7f800000u || exponent < 0) return uvec2(0u);
  if (exponent > 63) return uvec2(0xffffffffu);
  uvec2 whole = uvec2((bits & 0x7fffffu) | 0x800000u, 0u);
  return exponent < 23 ? sk_right(whole, uint(23 - exponent), 0u) : sk_left(whole, uint(exponent - 23));
}
// A magnitude with a sign, or the nearest number.
uvec2 sk_signed(uvec2 magnitude, bool isNegative) {
  if ((magnitude.y >> 31) != 0u) return isNegative ? uvec2(0u, 0x80000000u) : uvec2(0xffffffffu, 0x7fffffffu);
  return isNegative ? sk_opposite(magnitude) : magnitude;
}

sk_long sk_choose(bool c, sk_long a, sk_long b) { return sk_long(c ? a.bits : b.bits); }
sk_ulong sk_choose(bool c, sk_ulong a, sk_ulong b) { return sk_ulong(c ? a.bits : b.bits); }
sk_long sk_to_long(int a) { return sk_long(uvec2(uint(a), uint(a >> 31))); }
sk_long sk_to_long(uint a) { return sk_long(uvec2(a, 0u)); }
sk_long sk_to_long(sk_ulong a) { return sk_long(a.bits); }
sk_long sk_to_long(float a) { return sk_long(sk_signed(sk_truncated(a), a < 0.0)); }
sk_ulong sk_to_ulong(int a) { return sk_ulong(uvec2(uint(a), uint(a >> 31))); }
sk_ulong sk_to_ulong(uint a) { return sk_ulong(uvec2(a, 0u)); }
sk_ulong sk_to_ulong(sk_long a) { return sk_ulong(a.bits); }
sk_ulong sk_to_ulong(float a) { return sk_ulong(a > 0.0 ? sk_truncated(a) : uvec2(0u)); }
int sk_to_int(sk_long a) { return int(a.bits.x); }
int sk_to_int(sk_ulong a) { return int(a.bits.x); }
uint sk_to_uint(sk_long a) { return a.bits.x; }
uint sk_to_uint(sk_ulong a) { return a.bits.x; }
float sk_to_float(sk_ulong a) { return sk_nearest_of(a.bits); }
float sk_to_float(sk_long a) {
  float magnitude = sk_nearest_of(sk_magnitude_of(a.bits));
  return (a.bits.y >> 31) != 0u ? -magnitude : magnitude;
}

sk_long sk_neg(sk_long a) { return sk_long(sk_opposite(a.bits)); }
sk_long sk_inverse(sk_long a) { return sk_long(~a.bits); }
sk_long sk_add(sk_long a, sk_long b) { return sk_long(sk_sum_of(a.bits, b.bits)); }
sk_long sk_sub(sk_long a, sk_long b) { return sk_long(sk_sum_of(a.bits, sk_opposite(b.bits))); }
sk_long sk_mul(sk_long a, sk_long b) { return sk_long(sk_product_of(a.bits, b.bits)); }
sk_long sk_div(sk_long a, sk_long b) {
  uvec2 q = sk_divided(sk_magnitude_of(a.bits), sk_magnitude_of(b.bits)).xy;
  bool isZero = (b.bits.x | b.bits.y) == 0u;
  uint other = isZero ? 0u : b.bits.y;
  return sk_long(((a.bits.y ^ other) >> 31) != 0u ? sk_opposite(q) : q);
}
sk_long sk_rem(sk_long a, sk_long b) {
  uvec2 r = sk_divided(sk_magnitude_of(a.bits), sk_magnitude_of(b.bits)).zw;
  return sk_long((a.bits.y >> 31) != 0u ? sk_opposite(r) : r);
}
sk_long sk_div_by(sk_long a, uint d) {
  uvec2 q = sk_divided_by(sk_magnitude_of(a.bits), d).xy;
  return sk_long((a.bits.y >> 31) != 0u ? sk_opposite(q) : q);
}
sk_long sk_rem_by(sk_long a, uint d) {
  uvec2 r = uvec2(sk_divided_by(sk_magnitude_of(a.bits), d).z, 0u);
  return sk_long((a.bits.y >> 31) != 0u ? sk_opposite(r) : r);
}
sk_long sk_and(sk_long a, sk_long b) { return sk_long(a.bits & b.bits); }
sk_long sk_or(sk_long a, sk_long b) { return sk_long(a.bits | b.bits); }
sk_long sk_xor(sk_long a, sk_long b) { return sk_long(a.bits ^ b.bits); }
sk_long sk_shl(sk_long a, int n) { return sk_long(sk_left(a.bits, uint(n))); }
sk_long sk_shl(sk_long a, uint n) { return sk_long(sk_left(a.bits, n)); }
sk_long sk_shr(sk_long a, int n) { return sk_long(sk_right(a.bits, uint(n), sk_sign_of(a.bits))); }
sk_long sk_shr(sk_long a, uint n) { return sk_long(sk_right(a.bits, n, sk_sign_of(a.bits))); }
bool sk_less(sk_long a, sk_long b) {
  return sk_below(a.bits ^ uvec2(0u, 0x80000000u), b.bits ^ uvec2(0u, 0x80000000u));
}
bool sk_equal(sk_long a, sk_long b) { return a.bits == b.bits; }
int sk_popcount(sk_long a) { return sk_bits_set(a.bits.x) + sk_bits_set(a.bits.y); }
int sk_clz(sk_long a) { return sk_zeros_before(a.bits); }
int sk_ctz(sk_long a) { return sk_zeros_behind(a.bits); }
// The product without signs, less the other factor for each negative one.
sk_long sk_mulhi(sk_long a, sk_long b) {
  uvec2 less = sk_sum_of(b.bits & sk_sign_of(a.bits), a.bits & sk_sign_of(b.bits));
  return sk_long(sk_sum_of(sk_high_product(a.bits, b.bits), sk_opposite(less)));
}

sk_ulong sk_neg(sk_ulong a) { return sk_ulong(sk_opposite(a.bits)); }
sk_ulong sk_inverse(sk_ulong a) { return sk_ulong(~a.bits); }
sk_ulong sk_add(sk_ulong a, sk_ulong b) { return sk_ulong(sk_sum_of(a.bits, b.bits)); }
sk_ulong sk_sub(sk_ulong a, sk_ulong b) { return sk_ulong(sk_sum_of(a.bits, sk_opposite(b.bits))); }
sk_ulong sk_mul(sk_ulong a, sk_ulong b) { return sk_ulong(sk_product_of(a.bits, b.bits)); }
sk_ulong sk_div(sk_ulong a, sk_ulong b) { return sk_ulong(sk_divided(a.bits, b.bits).xy); }
sk_ulong sk_rem(sk_ulong a, sk_ulong b) { return sk_ulong(sk_divided(a.bits, b.bits).zw); }
sk_ulong sk_div_by(sk_ulong a, uint d) { return sk_ulong(sk_divided_by(a.bits, d).xy); }
sk_ulong sk_rem_by(sk_ulong a, uint d) { return sk_ulong(uvec2(sk_divided_by(a.bits, d).z, 0u)); }
sk_ulong sk_and(sk_ulong a, sk_ulong b) { return sk_ulong(a.bits & b.bits); }
sk_ulong sk_or(sk_ulong a, sk_ulong b) { return sk_ulong(a.bits | b.bits); }
sk_ulong sk_xor(sk_ulong a, sk_ulong b) { return sk_ulong(a.bits ^ b.bits); }
sk_ulong sk_shl(sk_ulong a, int n) { return sk_ulong(sk_left(a.bits, uint(n))); }
sk_ulong sk_shl(sk_ulong a, uint n) { return sk_ulong(sk_left(a.bits, n)); }
sk_ulong sk_shr(sk_ulong a, int n) { return sk_ulong(sk_right(a.bits, uint(n), 0u)); }
sk_ulong sk_shr(sk_ulong a, uint n) { return sk_ulong(sk_right(a.bits, n, 0u)); }
bool sk_less(sk_ulong a, sk_ulong b) { return sk_below(a.bits, b.bits); }
bool sk_equal(sk_ulong a, sk_ulong b) { return a.bits == b.bits; }
int sk_popcount(sk_ulong a) { return sk_bits_set(a.bits.x) + sk_bits_set(a.bits.y); }
int sk_clz(sk_ulong a) { return sk_zeros_before(a.bits); }
int sk_ctz(sk_ulong a) { return sk_zeros_behind(a.bits); }
sk_ulong sk_mulhi(sk_ulong a, sk_ulong b) { return sk_ulong(sk_high_product(a.bits, b.bits)); }

//// conversions
// The bits of the double that is nearest to a number without sign: 53 bits, rounded to even by the 11 below them.
uvec2 sk_double_bits(uvec2 a) {
  if ((a.x | a.y) == 0u) return uvec2(0u);
  int zeros = sk_zeros_before(a);
  a = sk_left(a, uint(zeros));
  uint rest = a.x & 0x7ffu;
  uvec2 whole = sk_right(a, 11u, 0u);
  bool isUp = rest > 0x400u || (rest == 0x400u && (whole.x & 1u) != 0u);
  // the highest bit of the mantissa adds 1 to the exponent, and so does a mantissa that is rounded up to the next power
  return sk_sum_of(sk_sum_of(whole, uvec2(uint(isUp), 0u)), uvec2(0u, uint(1023 + 63 - zeros - 1) << 20));
}
sk_double sk_to_double(sk_ulong a) { return sk_unpack(sk_double_bits(a.bits)); }
sk_double sk_to_double(sk_long a) {
  return sk_unpack(sk_double_bits(sk_magnitude_of(a.bits)) | uvec2(0u, a.bits.y & 0x80000000u));
}
// The magnitude of a double, truncated; all bits from 2^64 on, and 0 of NaN.
uvec2 sk_truncated(uvec2 bits) {
  bits.y &= 0x7fffffffu;
  int exponent = int(bits.y >> 20) - 1023;
  bool isNan = bits.y > 0x7ff00000u || (bits.y == 0x7ff00000u && bits.x != 0u);
  if (isNan || exponent < 0) return uvec2(0u);
  if (exponent > 63) return uvec2(0xffffffffu);
  uvec2 whole = uvec2(bits.x, (bits.y & 0xfffffu) | 0x100000u);
  return exponent < 52 ? sk_right(whole, uint(52 - exponent), 0u) : sk_left(whole, uint(exponent - 52));
}
sk_ulong sk_to_ulong(sk_double a) {
  uvec2 bits = sk_pack(a);
  return sk_ulong((bits.y >> 31) != 0u ? uvec2(0u) : sk_truncated(bits));
}
sk_long sk_to_long(sk_double a) {
  uvec2 bits = sk_pack(a);
  return sk_long(sk_signed(sk_truncated(bits), (bits.y >> 31) != 0u));
}
