// SPDX-License-Identifier: MIT
//
// Helper functions, templates, constants, names. The text is both a .sk file and C++ (see control_flow.hpp).
// clang-format off: a macro is a list
#define FUNCTION_CASES(CASE)                                                                       \
  CASE(overloads) CASE(overloadsByCount) CASE(defaultArguments) CASE(defaultFromCall)              \
  CASE(references) CASE(constReferences) CASE(voidFunctions) CASE(templates) CASE(templateValues)  \
  CASE(templateExplicit) CASE(templateRecursion) CASE(specialised) CASE(abbreviated)               \
  CASE(ifConstexpr) CASE(constants) CASE(constantExpressions) CASE(localConstants)                 \
  CASE(namespaces) CASE(nestedNamespaces) CASE(usings) CASE(aliases) CASE(autoTypes) CASE(macros)  \
  CASE(macroFunctions) CASE(conditionalText) CASE(glslWords) CASE(tooLikeOurs)                     \
  CASE(sameAsIntrinsics) CASE(declaredFirst) CASE(deepCalls) CASE(manyArguments) CASE(boolResults) \
  CASE(floatHelpers) CASE(constevalCalls) CASE(staticAsserts) CASE(parameterNames)                 \
  CASE(unicodeFree)
// clang-format on

namespace functions {

inline int kind(int) { return 1; }
inline int kind(float) { return 2; }
inline int kind(bool) { return 3; }
inline int kind(uint) { return 4; }
inline int overloads(int x, int y) {
  return kind(x) + 10 * kind(x * 0.5f) + 100 * kind(x < y) + 1000 * kind(uint(y)) + 10000 * kind(1.5f);
}
inline int many(int a) { return a; }
inline int many(int a, int b) { return a * 10 + b; }
inline int many(int a, int b, int c) { return many(a, b) * 10 + c; }
inline int overloadsByCount(int x, int y) { return many(x) + many(x, y) + many(x, y, 3); }

inline int offset(int x, int by = 5, bool twice = false) { return x + (twice ? 2 : 1) * by; }
inline int defaultArguments(int x, int y) { return offset(x) + 10 * offset(x, y) + 100 * offset(x, y, true); }
inline int four() { return 4; }
inline int scaled(int x, int by = four() + 1) { return x * by; }
inline int defaultFromCall(int x, int y) { return scaled(x) + scaled(y, 2); }

inline void divide(int a, int b, int& quotient, int& rest) {
  quotient = a / b;
  rest = a - quotient * b;
}
inline int references(int x, int y) {
  int q, r;
  divide(x + 100, 7, q, r);
  int s = 3;
  divide(s * y + 60, 5, s, q);
  return q * 100 + r * 10 + s;
}
inline int larger(const int& a, const int& b) { return a > b ? a : b; }
inline int constReferences(int x, int y) {
  return larger(x, y) + larger(3, x) * 10 + larger(larger(x, 1), y + 1);
}
inline void nothing() {}
inline void setIf(bool condition, int& a, int value) {
  if (!condition) return;
  a = value;
}
inline int voidFunctions(int x, int y) {
  int a = x;
  nothing();
  setIf(x > y, a, 100);
  setIf(y > 3, a, a + 1);
  return a;
}

template <class T>
T clampTo(T v, T low, T high) {
  return v < low ? low : v > high ? high : v;
}
template <class A, class B>
float sumOf(A a, B b) {
  return float(a) + float(b);
}
inline int templates(int x, int y) {
  return clampTo(x, 0, 5) + int(4 * clampTo(x * 0.5f, -1.0f, 1.0f)) + int(sumOf(x, 0.5f) * 2) +
         int(sumOf(true, y));
}
template <int N>
int power(int x) {
  int r = 1;
  for (int i = 0; i < N; ++i) r *= x;
  return r;
}
inline int templateValues(int x, int y) { return power<3>(x) + power<2>(y) * 10 + power<0>(x); }
template <class T, int N = 2>
T times(int x) {
  return T(x) * N;
}
inline int templateExplicit(int x, int y) { return int(times<float>(x) * 2) + times<int, 5>(y); }
template <int N>
int factorial(int x) {
  if constexpr (N <= 1)
    return x;
  else
    return N * factorial<N - 1>(x);
}
inline int templateRecursion(int x, int y) { return factorial<4>(x) + factorial<1>(y); }
template <class T>
int nameOf(T) {
  return 1;
}
template <>
inline int nameOf(float) {
  return 2;
}
inline int specialised(int x, int y) { return nameOf(x) + 10 * nameOf(float(y)); }
inline int abbreviated(int x, int y) {
  // one function for each type, as with auto parameters
  return nameOf(x < y) + nameOf(uint(x));
}
inline int ifConstexpr(int x, int y) {
  if constexpr (1 + 1 == 2) {
    return x;
  } else {
    return y;
  }
}

const int width = 12;
constexpr float half = 0.5f;
const bool isOn = true;
constexpr uint mask = 0xffu;
const int area = width * width + (isOn ? 1 : 0);
inline int constants(int x, int y) { return x * width + int(half * 4) + int(uint(y) & mask) + area + isOn; }
constexpr int sizes[3] = {width, width * 2, area / 3};
constexpr int chosen = width > 10 ? sizes[1] : -1;
const int negative = -width + ~3 + (7 & 5 | 8) + (1 << 4) - 17 % 5;
inline int constantExpressions(int x, int y) { return x * chosen + y * negative + sizes[2]; }
inline int localConstants(int x, int y) {
  const int a = 3, b = a * 4;
  constexpr int c = b + 1;
  const int d = x + b;
  static constexpr int e = 5;
  return a + b * 2 + c * 3 + d * 5 + e * y;
}

inline int step(int x) { return x + 1; }
namespace other {
inline int step(int x) { return x + 2; }
inline int both(int x) { return step(x) * functions::step(x); }
namespace deep {
const int depth = 2;
inline int step(int x) { return x + 3 + depth; }
}  // namespace deep
}  // namespace other
inline int namespaces(int x, int y) { return step(x) + 10 * other::step(x) + other::both(y); }
namespace other::deep {
inline int later(int x) { return step(x) * depth; }
}  // namespace other::deep
inline int nestedNamespaces(int x, int y) {
  return other::deep::step(x) + 10 * other::deep::later(y) + functions::other::deep::depth;
}
inline int usings(int x, int y) {
  using other::deep::later;
  namespace shortName = other::deep;
  using namespace other::deep;
  return later(x) + shortName::step(y) + depth;
}
using Number = int;
typedef float Real;
inline Number aliases(Number x, int y) {
  using Local = Real;
  Local f = x * 0.5f;
  return Number(f * 2) + y;
}
inline auto half2(int x) { return x * 0.5f; }
inline int autoTypes(int x, int y) {
  auto a = x * 2;
  const auto b = half2(y);
  auto c = x < y;
  decltype(a) d = c ? 3 : 4;
  return a + int(b * 4) + d;
}

#define SQUARE(v) ((v) * (v))
#define LIMIT 9
#define JOIN(a, b) a##b
#define SUM_OF(...) many(__VA_ARGS__)
inline int macros(int x, int y) {
  int JOIN(first, Second) = x + LIMIT;
  return SQUARE(x + 1) + firstSecond + y;
}
#define DEFINE_ADDER(name, by) \
  inline int name(int v) { return v + (by); }
DEFINE_ADDER(addTen, 10)
DEFINE_ADDER(addLimit, LIMIT)
inline int macroFunctions(int x, int y) {
  return addTen(x) + addLimit(y) * 2 + SUM_OF(x, y) + SUM_OF(x, y, 1);
}
inline int conditionalText(int x, int y) {
#if LIMIT > 5 && defined(SQUARE)
  int r = x;
#else
  int r = does not compile;
#endif
#ifdef NOT_DEFINED_ANYWHERE
  r += 1000;
#elif LIMIT == 9
  r += y;
#endif
  return r;
}

// Names that are reserved in GLSL, but not in C++.
inline int input(int attribute, int varying) { return attribute - varying; }
inline int texture(int sampler2D) { return sampler2D * 2; }
inline int glslWords(int x, int y) {
  int in = x, out = y, inout = 3, uniform = 4, precise = 5, highp = 6, flat = 7, discard = 8, common = 1,
      filter = 2;
  int vec4 = in + out, mat3 = inout, buffer = 9, gl_Position = 2, main = 3, ivec2 = 1, lowp = 2, smooth = 3;
  int shared = vec4 * mat3 + buffer, layout = texture(x), output = input(uniform, y), active = 1, superp = 2,
      sample = 4;
  return in + out + inout + uniform + precise + highp + flat + discard + common + filter + gl_Position +
         main + ivec2 + lowp + smooth + shared + layout + output + active + superp + sample;
}
// Names like those that skc makes, and forms of names that GLSL reserves.
inline int tooLikeOurs(int x, int y) {
  int sk_x = x, sk_index = y, t = 3, t_2 = 4, a__b = 5, self = 6, x_2 = 7;
  {
    int x = sk_x++;
    t += x;
    int t_2 = sk_index--;
    t += t_2;
  }
  return sk_x + sk_index + t + t_2 + a__b + self + x_2;
}
inline int dot(int a, int b) { return a * 10 + b; }
inline int length(int a) { return a + 7; }
inline int sameAsIntrinsics(int x, int y) {
  int sin = x, floor = y, max = 3;
  return functions::dot(sin, floor) + functions::length(max);
}
inline int defined_later(int x);
inline int declaredFirst(int x, int y) { return defined_later(x) + y; }
inline int defined_later(int x) { return x * 3; }
inline int level1(int x) { return x + 1; }
inline int level2(int x) { return level1(x) * 2 + level1(x + 1); }
inline int level3(int x) { return level2(x) - level2(level1(x)); }
inline int level4(int x) { return level3(level2(level1(x))); }
inline int deepCalls(int x, int y) { return level4(x) + level4(level3(y)); }
inline int manyArguments9(int a, int b, int c, int d, int e, int f, int g, int h, float i) {
  return a + 2 * b + 3 * c + 4 * d + 5 * e + 6 * f + 7 * g + 8 * h + int(i * 9);
}
inline int manyArguments(int x, int y) { return manyArguments9(x, y, 1, x, 2, y, 3, x + y, y * 1.0f); }
inline bool isEven(int x) { return (x & 1) == 0; }
inline bool isBetween(int x, int low, int high) { return low <= x && x < high; }
inline int boolResults(int x, int y) { return isEven(x) + 2 * isBetween(x, 0, y) + 4 * !isEven(y); }
inline float average(float a, float b) { return (a + b) * 0.5f; }
inline int floatHelpers(int x, int y) {
  return int(average(x, y) * 2) + int(average(average(x, 1), 3.5f) * 8);
}
constexpr int square(int x) { return x * x; }
constexpr int table5 = square(5);
inline int constevalCalls(int x, int y) { return square(x) + table5 * y; }
inline int staticAsserts(int x, int y) {
  static_assert(width == 12);
  static_assert(square(4) == 16, "constants are C++'s");
  return x - y;
}
inline int parameterNames(int r, int y) {
  int x = r;
  r += y;
  return x * r;
}
inline int unicodeFree(int x, int y) { return (x and y) + (x or y) * 2 + (not x) * 4 + (x bitand y) * 8; }

}  // namespace functions
