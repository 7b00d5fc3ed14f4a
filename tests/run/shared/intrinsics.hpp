// SPDX-License-Identifier: MIT
//
// The intrinsics of floats, one row each, for the .sk file, whose kernels only need the name, and for
// the test. CASE(name, reference in double, smallest x, largest x, absolute error, relative error). With
// two arguments, y is in [0.25, 4]; with three, y is in [-1, 1] and z in [1, 3].
//
// GLSL promises little. The error bounds are the largest errors that we measured, nearly all on llvmpipe,
// times 1.5 to 4. Measured errors: sine and cosine 1e-7 in [-100, 100], but 7e-6 on an NVIDIA H200;
// asin 3.9e-4, acos 1.6e-4; atan 2.1e-5 relative; exp 64 ulp (4e-6) at the ends of its range, pow 107 ulp;
// log 1.6e-7 absolute near 1. The hyperbolic functions are computed from exp and log and lose most digits
// near 0, so that only their absolute error is bounded. llvmpipe rounds + - * / and sqrt correctly; other
// drivers have errors up to 3 ulp.
#define EXACT 0, 0
#define FEW_ULP 1e-30, 4e-7

#define UNARY_CASES(CASE)                                       \
  CASE(radians, x * 3.14159265358979 / 180, -400, 400, FEW_ULP) \
  CASE(degrees, x * 180 / 3.14159265358979, -7, 7, FEW_ULP)     \
  CASE(sin, std::sin(x), -100, 100, 2e-5, 0)                    \
  CASE(cos, std::cos(x), -100, 100, 2e-5, 0)                    \
  CASE(tan, std::tan(x), -1.5, 1.5, 1e-6, 4e-6)                 \
  CASE(asin, std::asin(x), -1, 1, 6e-4, 0)                      \
  CASE(acos, std::acos(x), -1, 1, 6e-4, 0)                      \
  CASE(atan, std::atan(x), -10, 10, 1e-7, 4e-5)                 \
  CASE(sinh, std::sinh(x), -5, 5, 1e-6, 1e-5)                   \
  CASE(cosh, std::cosh(x), -5, 5, 0, 1e-5)                      \
  CASE(tanh, std::tanh(x), -5, 5, 2e-6, 0)                      \
  CASE(asinh, std::asinh(x), -10, 10, 2e-6, 1e-5)               \
  CASE(acosh, std::acosh(x), 1.25, 10, 2e-6, 1e-5)              \
  CASE(atanh, std::atanh(x), -0.95, 0.95, 2e-6, 1e-5)           \
  CASE(exp, std::exp(x), -10, 10, 0, 1e-5)                      \
  CASE(log, std::log(x), 0.01, 100, 1e-6, 1e-6)                 \
  CASE(exp2, std::exp2(x), -10, 10, 0, 1e-6)                    \
  CASE(log2, std::log2(x), 0.01, 100, 1e-6, 1e-6)               \
  CASE(log10, std::log10(x), 0.01, 100, 1e-6, 1e-6)             \
  CASE(log1p, std::log1p(x), -0.9, 10, FEW_ULP)                 \
  CASE(expm1, std::expm1(x), -5, 5, FEW_ULP)                    \
  CASE(cbrt, std::cbrt(x), -10, 10, FEW_ULP)                    \
  CASE(erf, std::erf(x), -4, 4, FEW_ULP)                        \
  CASE(erfc, std::erfc(x), -4, 4, 1e-30, 7e-7)                  \
  CASE(sqrt, std::sqrt(x), 0, 100, FEW_ULP)                     \
  CASE(inversesqrt, 1 / std::sqrt(x), 0.01, 100, FEW_ULP)       \
  CASE(rsqrt, 1 / std::sqrt(x), 0.01, 100, FEW_ULP)             \
  CASE(abs, std::fabs(x), -9, 9, EXACT)                         \
  CASE(fabs, std::fabs(x), -9, 9, EXACT)                        \
  CASE(sign, (x > 0) - (x < 0), -9, 9, EXACT)                   \
  CASE(floor, std::floor(x), -9, 9, EXACT)                      \
  CASE(trunc, std::trunc(x), -9, 9, EXACT)                      \
  CASE(round, std::round(x), -9.1, 9.3, EXACT)                  \
  CASE(roundEven, std::nearbyint(x), -9, 9, EXACT)              \
  CASE(ceil, std::ceil(x), -9, 9, EXACT)                        \
  CASE(fract, x - std::floor(x), -9, 9, 1e-7, 0)                \
  CASE(frac, x - std::floor(x), -9, 9, 1e-7, 0)                 \
  CASE(saturate, std::clamp(x, 0.0, 1.0), -2, 3, EXACT)         \
  CASE(normalize, std::nan(""), 0.5, 9, 1e-6, 0)

#define BINARY_CASES(CASE)                           \
  CASE(atan, std::atan2(x, y), -10, 10, 1e-7, 4e-5)  \
  CASE(atan2, std::atan2(x, y), -10, 10, 1e-7, 4e-5) \
  CASE(hypot, std::hypot(x, y), -10, 10, FEW_ULP)    \
  CASE(pow, std::pow(x, y), 0.1, 10, 0, 2e-5)        \
  CASE(fmod, x - y * std::trunc(x / y), -9, 9, 2e-6, 0)

// F(F,F) and, with y a scalar, F(F,f)
#define BINARY_SCALAR_CASES(CASE)                      \
  CASE(mod, x - y * std::floor(x / y), -9, 9, 2e-6, 0) \
  CASE(min, std::min(x, y), -9, 9, EXACT)              \
  CASE(max, std::max(x, y), -9, 9, EXACT)              \
  CASE(fmin, std::fmin(x, y), -9, 9, EXACT)            \
  CASE(fmax, std::fmax(x, y), -9, 9, EXACT)

#define TERNARY_CASES(CASE)                       \
  CASE(clamp, std::clamp(x, y, z), -9, 9, EXACT)  \
  CASE(mix, x * (1 - z) + y * z, -9, 9, 4e-6, 0)  \
  CASE(lerp, x * (1 - z) + y * z, -9, 9, 4e-6, 0) \
  CASE(fma, x* y + z, -9, 9, 1e-6, 0)
