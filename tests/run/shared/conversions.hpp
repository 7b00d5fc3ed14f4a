// SPDX-License-Identifier: MIT
//
// Conversions between bool, int, uint and float. The text is both a .sk file and C++ (see control_flow.hpp). No float is
// converted to an integer type that cannot hold it.
// clang-format off: a macro is a list
#define FLOAT_TO_INT_CASES(CASE)                                                                   \
  CASE(truncate) CASE(castSpellings) CASE(toUnsigned) CASE(floatTests) CASE(intFromSum)
#define INT_TO_FLOAT_CASES(CASE)                                                                   \
  CASE(toFloat) CASE(unsignedToFloat) CASE(boolToFloat) CASE(mixedArithmetic)                      \
  CASE(integerDivisionFirst) CASE(mixedCompound) CASE(mixedComparison) CASE(mixedConditional)
#define INT_TO_INT_CASES(CASE)                                                                     \
  CASE(toBool) CASE(signs) CASE(enumerators) CASE(scopedEnumerators) CASE(throughFloat)            \
  CASE(compoundThroughFloat) CASE(incrementFloat) CASE(characters)
// clang-format on

namespace conversions {

inline int truncate(float x, float y) { return int(x) * 3 - int(y); }
inline int castSpellings(float x, float y) {
  int a = x, b = (int)y, c = static_cast<int>(x), d{int(y)};
  auto e = int(x + y);
  return a + b * 2 + c * 3 + d * 5 + e * 7;
}
inline int toUnsigned(float x, float y) {
  float a = x < 0 ? -x : x, b = y < 0 ? -y : y;
  return int(uint(a) ^ static_cast<uint>(b));
}
inline int floatTests(float x, float y) {
  bool p = x, q = bool(y);
  int r = p + 2 * q;
  if (x) r += 4;
  if (!y) r += 8;
  r += x ? 16 : 32;
  r += (x && y) * 64 + (x || y) * 128;
  return r;
}
inline int intFromSum(float x, float y) {
  int sum = 3;
  sum += x;  // computed in float
  sum -= y;
  return sum;
}

inline float toFloat(int x, int y) { return float(x) + y * 0.5f; }
inline float unsignedToFloat(int x, int y) {
  return float(uint(x)) - static_cast<float>(static_cast<uint>(y));
}
inline float boolToFloat(int x, int y) { return float(x > y) + (x == y) * 0.25f; }
inline float mixedArithmetic(int x, int y) { return x * 0.25f + y - 2 * (x - 0.5f) + (y & 3) / 2.0f; }
inline float integerDivisionFirst(int x, int y) { return x / 3 + y / 2 * 1.5f + (x > 0) / 2.0f; }
inline float mixedCompound(int x, int y) {
  float f = x;
  f += y;
  f *= 2;
  f -= y > 3;
  f /= 4;
  return f;
}
inline float mixedComparison(int x, int y) {
  return (x < y + 0.5f) + 2 * (x == float(y)) + 4.0f * (x >= 2.5f);
}
inline float mixedConditional(int x, int y) { return (x > y ? x : 0.5f) + (y > 0 ? 1.5f : y); }

inline int toBool(int x, int y) {
  bool p = x, q = static_cast<bool>(y), r = x & 4;
  return p + 2 * q + 4 * r + 8 * int(bool(x - y));
}
inline int signs(int x, int y) {
  uint u = x, v = static_cast<uint>(y);
  int back = u + v;
  return back + int(u > v) + (x < 0 ? int(-u) : int(u >> 1));
}
enum Mode { Off, Low = 5, High };
inline Mode modeOf(int x) { return x < 0 ? Off : x < 4 ? Low : High; }
inline int enumerators(int x, int y) {
  Mode m = modeOf(x);
  int r = m + Low * 10;
  if (m == High) r += 100;
  switch (modeOf(y)) {
    case Off: r += 1000; break;
    case Low: r += 2000; break;
    case High: r += 3000; break;
  }
  m = Mode(y & 1 ? Low : Off);
  return r + m;
}
enum class Side : uint { Left = 1, Right = 0xfu };
inline int scopedEnumerators(int x, int y) {
  Side s = x < y ? Side::Left : Side::Right;
  const Side t = static_cast<Side>(uint(y & 15));
  return int(s) * 100 + static_cast<int>(t) + (s == Side::Left) + (t != s);
}
inline int throughFloat(int x, int y) { return int(float(x) * 0.5f) + int(y / 2.0f); }
inline int compoundThroughFloat(int x, int y) {
  int i = x;
  i *= 1.5f;
  i += y * 0.25f;
  i -= true;
  return i;
}
inline int incrementFloat(int x, int y) {
  float f = x;
  f++;
  ++f;
  float g = f-- + y;
  --g;
  return int(f * 10 + g);
}
inline int characters(int x, int y) { return x + 'A' - '\0' + (y == '\n' ? 1 : 0); }

}  // namespace conversions
