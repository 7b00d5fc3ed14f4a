// SPDX-License-Identifier: MIT
//
// Integer arithmetic. The text is both a .sk file and C++ (see control_flow.hpp). It has no signed overflow or other
// undefined behaviour: sums that wrap are unsigned.
// clang-format off: a macro is a list
#define INT_CASES(CASE)                                                                            \
  CASE(sum) CASE(product) CASE(quotient) CASE(remainder) CASE(remainderByConstant)                 \
  CASE(quotientByConstant) CASE(bitAnd) CASE(bitOr) CASE(bitXor) CASE(complement) CASE(negation)   \
  CASE(shiftLeft) CASE(shiftRight) CASE(shiftConstant) CASE(compare) CASE(precedence)              \
  CASE(associativity) CASE(unaryMix) CASE(literals) CASE(bitTricks) CASE(selfAssigned)             \
  CASE(minimum) CASE(boolsAsInts) CASE(hexAndBinary)
#define UINT_CASES(CASE)                                                                           \
  CASE(wrappingSum) CASE(wrappingProduct) CASE(unsignedQuotient) CASE(unsignedRemainder)           \
  CASE(unsignedShifts) CASE(unsignedCompare) CASE(unsignedNegation) CASE(mixedSigns) CASE(hash)    \
  CASE(rotate) CASE(popCount) CASE(multiplyHigh) CASE(largeLiterals) CASE(bitFields)               \
  CASE(linearCongruence) CASE(powerModulo)
// clang-format on

namespace integers {

inline int sum(int x, int y) { return static_cast<int>(static_cast<uint>(x) + static_cast<uint>(y)); }
inline int product(int x, int y) { return static_cast<int>(static_cast<uint>(x) * static_cast<uint>(y)); }
// tests/numerics/arithmetic_test.cpp tests the quotient that overflows, and quotients by zero.
inline bool isUndefined(int x, int y) { return y == 0 || (y == -1 && x == -2147483647 - 1); }
inline int quotient(int x, int y) { return isUndefined(x, y) ? 0 : x / y; }
inline int remainder(int x, int y) { return isUndefined(x, y) ? 0 : x % y; }
inline int remainderByConstant(int x, int y) {
  return x % 7 + (y % 16) * 3 + (x % -5) * 100 + (y % 2) * 1000;
}
inline int quotientByConstant(int x, int y) { return x / 3 - y / 16 + x / -7 + y / 2; }
inline int bitAnd(int x, int y) { return x & y; }
inline int bitOr(int x, int y) { return x | y; }
inline int bitXor(int x, int y) { return x ^ y; }
inline int complement(int x, int y) { return ~x ^ ~(y & 0xff); }
inline int negation(int x, int y) {
  int a = x / 2, b = y / 2;
  return -a - -b + -(-a) - (+b);
}
inline int shiftLeft(int x, int y) { return x << (y & 31); }
inline int shiftRight(int x, int y) { return x >> (y & 31); }
inline int shiftConstant(int x, int y) { return (x << 3) ^ (y >> 31) ^ (x >> 1) ^ (1 << 31) ^ (y << 0); }
inline int compare(int x, int y) {
  return (x < y) + 2 * (x <= y) + 4 * (x > y) + 8 * (x >= y) + 16 * (x == y) + 32 * (x != y);
}
inline int precedence(int x, int y) {
  int a = x & 255, b = y & 255;
  int r = a + b * 2 - a / 3 % 5 + (b << 1 + 1) - (a & b | 3 ^ b) + (a == b & 1) + (a < b == b > 3);
  r ^= a << 2 >> 1;
  r += -a * -b - (-(a - b) - (a - (b - 3)));
  r += a | b & 12;
  r += !a + !!b + ~a * 2;
  r += a > 3 && b > 3 || a == b && !(a < 100) ? 1000 : a < b ? 2000 : 3000;
  return r;
}
inline int associativity(int x, int y) {
  int a = x & 255, b = (y & 63) + 1;
  return a - b - 3 - (b - 4) + a / b / 2 + a % b % 3 + a / (b * 2) + a * (b / 2) - (a - (b - (a - 1))) +
         a / b * b + a % (b + 1) * 2 + a * b % 7 + (a >> 1 >> 1) - (a >> (b & 3) << 1);
}
inline int unaryMix(int x, int y) {
  int a = x & 1023, b = y & 1023;
  return - -a + ~-b - -~a * - - -b + !-a - ~~b;
}
inline int literals(int x, int y) {
  return (x & 0x7fffffff) ^ 2147483647 ^ (-2147483647 - 1) ^ 1'000'000 ^ 'a' ^ 017 ^ (y & -2147483647);
}
inline int bitTricks(int x, int y) {
  uint a = static_cast<uint>(x);
  uint lowest = a & (0u - a);
  int sign = (x >> 31) | static_cast<int>((0u - a) >> 31);
  return static_cast<int>(lowest) ^ sign ^ ((x ^ y) & 0x0f0f) ^ static_cast<int>(a & (a - 1u));
}
inline int selfAssigned(int x, int y) {
  uint a = static_cast<uint>(x);
  a += a;
  a ^= a << 1;
  a -= a >> 3;
  a *= a;
  return static_cast<int>(a ^ static_cast<uint>(y));
}
inline int minimum(int x, int y) { return x < y ? x : y; }
inline int boolsAsInts(int x, int y) {
  bool p = x, q = y > 5;
  int n = p + q + q;
  p = n > 1;
  n += p ? 10 : 20;
  n += (p & q) + 2 * (p | q) + 4 * (p ^ q);
  n += p == q;
  q = !p;
  p &= x > 0;
  q |= y < 0;
  return n * 4 + p + 2 * q;
}
inline int hexAndBinary(int x, int y) { return (x & 0xFF) + (y & 0b1011) + 0X1F + 0777; }

inline uint wrappingSum(uint x, uint y) { return x + y - 3u + 0xfffffff0u; }
inline uint wrappingProduct(uint x, uint y) { return x * y * 2654435761u; }
inline uint unsignedQuotient(uint x, uint y) { return y == 0u ? x / 3u : x / y; }
inline uint unsignedRemainder(uint x, uint y) { return y == 0u ? x % 10u : x % y; }
inline uint unsignedShifts(uint x, uint y) {
  uint s = y & 31u;
  return (x << s) ^ (x >> s) ^ (x >> 31) ^ (x << 31u);
}
inline uint unsignedCompare(uint x, uint y) {
  return uint(x < y) + 2u * uint(x <= y) + 4u * uint(x > y) + 8u * uint(x >= y) + 16u * uint(x == y) +
         32u * uint(x != y);
}
inline uint unsignedNegation(uint x, uint y) { return -x + ~y + (0u - 1u) - -y; }
inline uint mixedSigns(uint x, uint y) {
  int a = static_cast<int>(x), b = -3;
  uint r = x + static_cast<uint>(b);
  r += static_cast<uint>(a / 2) + (y >> 1);
  if (b < static_cast<int>(y & 15u)) r += 100u;
  if (a < b) r ^= 0x55u;
  r += 2 * y + (1 << 4);
  return r;
}
inline uint hash(uint x, uint y) {
  uint h = 2166136261u;
  for (int i = 0; i < 4; ++i) {
    h = (h ^ ((x >> (8 * i)) & 0xffu)) * 16777619u;
    h = (h ^ ((y >> (8 * i)) & 0xffu)) * 16777619u;
  }
  return h;
}
inline uint rotate(uint x, uint y) {
  uint s = y % 31u + 1u;
  return (x << s) | (x >> (32u - s));
}
inline uint popCount(uint x, uint y) {
  uint v = x ^ y;
  v = v - ((v >> 1) & 0x55555555u);
  v = (v & 0x33333333u) + ((v >> 2) & 0x33333333u);
  return ((v + (v >> 4) & 0xf0f0f0fu) * 0x1010101u) >> 24;
}
inline uint multiplyHigh(uint x, uint y) {
  uint a = x & 0xffffu, b = x >> 16, c = y & 0xffffu, d = y >> 16;
  uint low = a * c, mid = b * c + (low >> 16), carry = a * d + (mid & 0xffffu);
  return b * d + (mid >> 16) + (carry >> 16);
}
inline uint largeLiterals(uint x, uint y) {
  return (x ^ 0xdeadbeefu) + (y | 0x80000000u) + 4294967295u + 3000000000u;
}
inline uint bitFields(uint x, uint y) {
  uint packed = (x & 0x3ffu) | ((y & 0x3ffu) << 10) | ((x >> 22) << 20);
  return (packed >> 10 & 0x3ffu) * 3u + (packed & 0x3ffu) + (packed >> 20);
}
inline uint linearCongruence(uint x, uint y) {
  uint s = x;
  for (uint i = 0u; i < (y & 15u); i++) s = s * 1664525u + 1013904223u;
  return s;
}
inline uint powerModulo(uint x, uint y) {
  uint base = x % 65521u, e = y & 1023u, r = 1u;
  while (e > 0u) {
    if (e & 1u) r = r * base % 65521u;
    base = base * base % 65521u;
    e >>= 1;
  }
  return r;
}

}  // namespace integers
