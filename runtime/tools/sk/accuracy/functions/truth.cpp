// SPDX-License-Identifier: MIT
//
// These loops are compiled with options of their own (CMakeLists.txt), by which GCC calls the vector functions of glibc.
#include "accuracy/functions/truth.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#if defined(SK_VECTOR_FUNCTIONS)
#define SK_FOR_EACH_LEVEL __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
// As math.h declares them with -ffast-math, which would also change what these loops mean.
#define SK_VECTOR(name) extern "C" __attribute__((__simd__("notinbranch"))) double name(double) noexcept
SK_VECTOR(sin);
SK_VECTOR(cos);
SK_VECTOR(tan);
SK_VECTOR(asin);
SK_VECTOR(acos);
SK_VECTOR(atan);
SK_VECTOR(sinh);
SK_VECTOR(cosh);
SK_VECTOR(tanh);
SK_VECTOR(asinh);
SK_VECTOR(acosh);
SK_VECTOR(atanh);
SK_VECTOR(exp);
SK_VECTOR(exp2);
SK_VECTOR(log);
SK_VECTOR(log2);
SK_VECTOR(log10);
#undef SK_VECTOR
#define SK_SIMD _Pragma("omp simd")
#define SK_SIMD_OF_ERRORS _Pragma("omp simd reduction(max : largest) reduction(+ : notNearest)")
#else
#define SK_FOR_EACH_LEVEL
#define SK_SIMD
#define SK_SIMD_OF_ERRORS
#endif

namespace sk_tool {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The vector functions are slow for arguments outside of these ranges, where a value is as good as infinity or 0, or is NaN.
double within(double x, double low, double high) { return x < low ? low : x > high ? high : x; }
double definedFrom(double low, double x, double value) { return x < low ? nan : value; }
double definedIn(double x, double value) { return x < -1 || x > 1 ? nan : value; }

// name, its value for x in double and in long double, and the range of most arguments that are drawn
#define SK_TRUTHS                                                                \
  SK_TRUTH(sin, ::sin(x), sinl(x), -10, 10)                                      \
  SK_TRUTH(cos, ::cos(x), cosl(x), -10, 10)                                      \
  SK_TRUTH(tan, ::tan(x), tanl(x), -10, 10)                                      \
  SK_TRUTH(asin, definedIn(x, ::asin(within(x, -1, 1))), asinl(x), -1, 1)        \
  SK_TRUTH(acos, definedIn(x, ::acos(within(x, -1, 1))), acosl(x), -1, 1)        \
  SK_TRUTH(atan, ::atan(x), atanl(x), -4, 4)                                     \
  SK_TRUTH(sinh, ::sinh(within(x, -700, 700)), sinhl(x), -30, 30)                \
  SK_TRUTH(cosh, ::cosh(within(x, -700, 700)), coshl(x), -30, 30)                \
  SK_TRUTH(tanh, ::tanh(within(x, -700, 700)), tanhl(x), -10, 10)                \
  SK_TRUTH(asinh, ::asinh(x), asinhl(x), -4, 4)                                  \
  SK_TRUTH(acosh, definedFrom(1, x, ::acosh(x < 1 ? 1 : x)), acoshl(x), 1, 4)    \
  SK_TRUTH(atanh, definedIn(x, ::atanh(within(x, -1, 1))), atanhl(x), -1, 1)     \
  SK_TRUTH(exp, ::exp(within(x, -700, 700)), expl(x), -87, 88)                   \
  SK_TRUTH(exp2, ::exp2(within(x, -1000, 1000)), exp2l(x), -126, 128)            \
  SK_TRUTH(log, definedFrom(0, x, ::log(x < 0 ? 1 : x)), logl(x), 0.5, 2)        \
  SK_TRUTH(log2, definedFrom(0, x, ::log2(x < 0 ? 1 : x)), log2l(x), 0.5, 2)     \
  SK_TRUTH(log10, definedFrom(0, x, ::log10(x < 0 ? 1 : x)), log10l(x), 0.5, 2)  \
  SK_TRUTH(log1p, definedFrom(-1, x, ::log1p(x < -1 ? 0 : x)), log1pl(x), -1, 2) \
  SK_TRUTH(expm1, ::expm1(within(x, -700, 700)), expm1l(x), -2, 88)              \
  SK_TRUTH(cbrt, ::cbrt(x), cbrtl(x), 0.5, 8)                                    \
  SK_TRUTH(erf, ::erf(x), erfl(x), -4, 4)                                        \
  SK_TRUTH(erfc, ::erfc(within(x, -30, 26)), erfcl(x), -4, 26)                   \
  SK_TRUTH(sqrt, __builtin_sqrt(x), __builtin_sqrtl(x), 0, 4)                    \
  SK_TRUTH(inversesqrt, 1 / __builtin_sqrt(x), 1 / __builtin_sqrtl(x), 0, 4)     \
  SK_TRUTH(fract, x - __builtin_floor(x), x - __builtin_floorl(x), -100, 100)

#define SK_TRUTH(name, inDouble, inLongDouble, low, high)                                  \
  SK_FOR_EACH_LEVEL void name##OfAll(const float* xs, double* values, std::size_t count) { \
    SK_SIMD for (std::size_t i = 0; i < count; ++i) {                                      \
      const double x = xs[i];                                                              \
      values[i] = inDouble;                                                                \
    }                                                                                      \
  }                                                                                        \
  long double name##Exactly(long double x) { return inLongDouble; }
SK_TRUTHS
#undef SK_TRUTH

constexpr UnaryFunction all[] = {
#define SK_TRUTH(name, inDouble, inLongDouble, low, high) \
  {#name, f_##name, name##OfAll, name##Exactly, low, high},
    SK_TRUTHS
#undef SK_TRUTH
};

}  // namespace

std::span<const UnaryFunction> unaryFunctions() { return all; }

std::span<const BinaryFunction> binaryFunctions() {
  static const BinaryFunction functions[] = {
      {"pow",
       f_pow,
       [](long double x, long double y) { return powl(x, y); },
       {{1e-3, 1e3, -12, 12},
        {0.5, 2, -120, 120},
        {0.99, 1.01, -8000, 8000},
        {1, 1.0000001, 1e6, 1e9},
        {1, 1e37, -1, 1},
        {0.6, 0.8, -160, 160}}},
      {"atan2",
       f_atan2,
       [](long double y, long double x) { return atan2l(y, x); },
       {{-10, 10, -10, 10},
        {-1, 1, 0.99, 1.01},
        {1e-3, 1e3, -12, 12},
        {-1e-3, 1e-3, -10, 10},
        {-1, 1, -1e-3, 1e-3}}},
      {"hypot",
       f_hypot,
       [](long double x, long double y) { return hypotl(x, y); },
       {{-10, 10, -10, 10},
        {-1, 1, 0.99, 1.01},
        {1e-3, 1e3, -12, 12},
        {-1e-3, 1e-3, -10, 10},
        {1e-30, 2e-30, 1e-30, 2e-30}}},
  };
  return functions;
}

SK_FOR_EACH_LEVEL void floatsFrom(std::uint64_t first, std::uint64_t every, float* floats,
                                  std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    floats[i] = std::bit_cast<float>(static_cast<std::uint32_t>(first + i * every));
}

SK_FOR_EACH_LEVEL ErrorSummary errorsOf(const float* results, const double* exact, double* errors,
                                        std::size_t count) {
  constexpr double overflow = 0x1p128, infinity = std::numeric_limits<double>::infinity();
  constexpr std::int64_t bias = 1023;
  double largest = 0;
  std::int64_t notNearest = 0;
  SK_SIMD_OF_ERRORS
  for (std::size_t i = 0; i < count; ++i) {
    const double wanted = exact[i], got = results[i];
    const auto field = static_cast<std::int64_t>((std::bit_cast<std::uint64_t>(wanted) >> 52) & 0x7ff);
    const std::int64_t atLeast = field < bias - 126 ? bias - 126 : field;
    const std::int64_t exponent = atLeast > bias + 127 ? bias + 127 : atLeast;
    const double units = std::bit_cast<double>(static_cast<std::uint64_t>(bias + 23 + bias - exponent) << 52);
    const double g = got > overflow ? overflow : got < -overflow ? -overflow : got;
    const double w = wanted > overflow ? overflow : wanted < -overflow ? -overflow : wanted;
    const double distance = __builtin_fabs(g - w) * units;
    const auto signs =
        static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(got) ^ std::bit_cast<std::uint64_t>(wanted));
    const double ofNumbers = got == 0 && signs < 0 ? infinity : distance;
    const double ofOneNan = ofNumbers == ofNumbers ? ofNumbers : infinity;
    const double error = got != got && wanted != wanted ? 0 : ofOneNan;
    errors[i] = error;
    largest = largest < error ? error : largest;
    notNearest += error > 0.5 ? 1 : 0;
  }
  return {largest, static_cast<std::uint64_t>(notNearest)};
}

}  // namespace sk_tool
