// SPDX-License-Identifier: MIT
//
// What kernels compute element by element: functions within their bounds, and operations that round once.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "numbers/adversary.sk.hpp"
#include "numbers/operations.hpp"
#include "numbers/signature.hpp"

namespace fuzz::numbers {
namespace {

using Judge = MapJudge;

struct Function {
  const char* name;
  numerics::Unary exact;
};
constexpr Function circular[] = {{"sin", mpfr_sin}, {"cos", mpfr_cos}, {"tan", mpfr_tan}};
constexpr Function arcs[] = {{"asin", mpfr_asin}, {"acos", mpfr_acos}, {"atan", mpfr_atan}};
constexpr Function hyperbolic[] = {{"sinh", mpfr_sinh}, {"cosh", mpfr_cosh}, {"tanh", mpfr_tanh}};
constexpr Function areas[] = {{"asinh", mpfr_asinh}, {"acosh", mpfr_acosh}, {"atanh", mpfr_atanh}};
constexpr Function exponentials[] = {{"exp", mpfr_exp}, {"exp2", mpfr_exp2}};
constexpr Function near0[] = {{"log1p", mpfr_log1p}, {"expm1", mpfr_expm1}, {"cbrt", mpfr_cbrt}};
constexpr Function errors[] = {{"erf", mpfr_erf}, {"erfc", mpfr_erfc}};
constexpr Function logarithms[] = {{"log", mpfr_log}, {"log2", mpfr_log2}, {"log10", mpfr_log10}};

/// C's reciprocal root: of -0, it is -infinity, where MPFR has infinity.
int reciprocalRoot(mpfr_t result, const mpfr_t x, mpfr_rnd_t rounding) {
  if (mpfr_zero_p(x)) {
    mpfr_set_inf(result, mpfr_signbit(x) ? -1 : 1);
    return 0;
  }
  return mpfr_rec_sqrt(result, x, rounding);
}
constexpr Function roots[] = {{"sqrt", mpfr_sqrt}, {"inversesqrt", reciprocalRoot}, {"cbrt", mpfr_cbrt}};

template <const auto& functions>
bool acceptsFunctions(const Judge& judge, Arguments x, std::size_t output, double got) {
  return judge.isFunction(functions[output].name, functions[output].exact, x[0], got);
}
template <const auto& functions>
bool acceptsWide(const Judge& judge, Arguments x, std::size_t output, double got) {
  return judge.isWideFunction(functions[output].name, functions[output].exact, x[0], got);
}

bool acceptsPowers(const Judge& judge, Arguments x, std::size_t output, double got) {
  return output == 0   ? judge.isFunction("pow", mpfr_pow, x[0], x[1], got)
         : output == 1 ? judge.isFunction("atan2", mpfr_atan2, x[0], x[1], got)
                       : judge.isFunction("hypot", mpfr_hypot, x[0], x[1], got);
}
bool acceptsWidePowers(const Judge& judge, Arguments x, std::size_t output, double got) {
  return output == 0   ? judge.isWideFunction("pow", mpfr_pow, x[0], x[1], got)
         : output == 1 ? judge.isWideFunction("atan2", mpfr_atan2, x[0], x[1], got)
                       : judge.isWideFunction("hypot", mpfr_hypot, x[0], x[1], got);
}

bool acceptsRemainders(const Judge& judge, Arguments x, std::size_t output, double got) {
  const bool isWide =
      judge.options.precision == sk::Precision::Double || judge.options.precision == sk::Precision::Extended;
  if (isWide && !judge.arithmetic.isNative) return true;  // of doubles, it is left to the device
  const double remainder = std::fmod(x[0], x[1]);
  if (output == 0) return judge.equals(static_cast<float>(remainder), got);
  const bool isOtherSign = remainder != 0 && std::signbit(remainder) != std::signbit(x[1]);
  return judge.isFunction("mod", numerics::floorModulo, x[0], x[1], got) ||
         judge.equals(static_cast<float>(isOtherSign ? remainder + x[1] : remainder), got);
}

bool acceptsLengths(const Judge& judge, Arguments x, std::size_t output, double got) {
  if (std::isinf(x[0]) || std::isinf(x[1]) || std::isinf(x[2])) return output > 0 || std::isinf(got);
  const double length = std::hypot(x[0], x[1], x[2]);
  if (std::isnan(length)) return output > 0 || std::isnan(got);
  const double exact = output == 0 ? length : length == 0 ? x[output - 1] * 0 : x[output - 1] / length;
  const double unit = std::ldexp(1.0, std::max(exact == 0 ? -126 : std::ilogb(exact), -126) - 23);
  if (std::fabs(exact) > 0x1.fffff8p127) return std::fabs(got) > 0x1.fffff0p127;
  if (std::fabs(got - exact) <= unit * (output == 0 ? 2 : 3)) return true;
  return judge.arithmetic.flushesDenormals && std::fabs(exact) < 0x1p-125 && std::fabs(got) < 0x1p-125;
}

/// a op b: of floats, each of which a Half call rounds before.
std::array<double, 4> operationsOf(const Judge& judge, Arguments x) {
  const bool isHalf = judge.options.precision == sk::Precision::Half;
  const double a = isHalf ? toHalf(x[0]) : x[0], b = isHalf ? toHalf(x[1]) : x[1];
  return {a + b, a - b, a * b, a / b};
}
bool acceptsOperators(const Judge& judge, Arguments x, std::size_t output, double got) {
  if (judge.options.precision == sk::Precision::Default || judge.options.precision == sk::Precision::Single) {
    const auto a = static_cast<float>(x[0]), b = static_cast<float>(x[1]);
    const std::array<float, 4> wanted{a + b, a - b, a * b, a / b};
    return output == 3 ? judge.isQuotient(wanted[output], x[1], got) : judge.equals(wanted[output], got);
  }
  if (judge.isRounded(operationsOf(judge, x)[output], got)) return true;
  if (output == 3 && judge.isAnyQuotient(x[1])) return true;
  // a denormal argument may be 0, and its product 0 of either sign
  const std::array<double, 2> flushed{judge.flushed(x[0]), judge.flushed(x[1])};
  if (flushed == std::array{x[0], x[1]}) return false;
  const double wanted = operationsOf(judge, flushed)[output];
  return judge.isRounded(wanted, got) || (wanted == 0 && got == 0);
}
bool acceptsWideOperators(const Judge& judge, Arguments x, std::size_t output, double got) {
  if (output == 3 && judge.arithmetic.hasPairs && judge.isAnyQuotient(x[1])) return true;
  return judge.equalsDouble(std::array{x[0] + x[1], x[0] - x[1], x[0] * x[1], x[0] / x[1]}[output], got);
}

bool acceptsFused(const Judge& judge, Arguments x, std::size_t output, double got) {
  const double c = output == 0 ? x[2] : output == 1 ? -x[2] : x[2], sign = output == 2 ? -1 : 1;
  const auto a = static_cast<float>(sign * x[0]), b = static_cast<float>(x[1]), third = static_cast<float>(c);
  const auto product = static_cast<double>(a) * static_cast<double>(b);
  if (judge.options.precision == sk::Precision::Double)
    return judge.equals(static_cast<float>(product + c), got);
  if (judge.options.precision == sk::Precision::Extended) {
    if (judge.isRounded(product + c, got, std::max(std::fabs(product), std::fabs(c)))) return true;
    return !judge.arithmetic.isNative && std::fabs(product) < 0x1p-76 &&
           std::fabs(got - (product + c)) <= 0x1p-122;
  }
  const float once = std::fma(a, b, third), twice = static_cast<float>(product) + third;
  const bool isFast = judge.options.contraction == sk::Contraction::Fast;
  const bool mayFuse = !judge.arithmetic.isNative || isFast;
  // Contracted native code fuses what the kernel calls fma, on processors that can.
  const bool mustFuse = judge.arithmetic.isNative && isFast && output < 2 && __builtin_cpu_supports("fma");
  if ((mayFuse && judge.equals(once, got)) || (!mustFuse && judge.equals(twice, got))) return true;
  return judge.arithmetic.flushesDenormals && std::fabs(product) <= 0x1p-126 &&
         (judge.equals(third, got) || (third == 0 && got == 0));
}

/// What literals() computes where `round` rounds each operation.
template <class Round>
std::array<double, 4> literalsOf(double x, const Round& round) {
  const double third = round(1.0 / 3.0);
  return {round(x * third), round(round(x * round(0.1)) * 10), round(round(x + 1.25) - 1.25),
          round(round(round(3 * third) - 1) * x)};
}
bool acceptsLiterals(const Judge& judge, Arguments x, std::size_t output, double got) {
  switch (judge.options.precision) {
    case sk::Precision::Half: {
      if (!std::isfinite(toHalf(x[0]))) return true;
      return judge.equals(static_cast<float>(literalsOf(toHalf(x[0]), toHalf)[output]), got) ||
             (output == 3 && got == 0);
    }
    case sk::Precision::Double:
      return judge.equals(static_cast<float>(literalsOf(x[0], [](double v) { return v; })[output]), got) ||
             (output == 3 && got == 0);
    case sk::Precision::Extended: {
      if (!std::isfinite(x[0])) return true;
      if (std::isinf(got)) return std::fabs(x[0]) > 0x1p120;
      const double scale = output == 2 ? std::max(std::fabs(x[0]), 1.25) : std::fabs(x[0]);
      const double wanted = output == 3 ? 0 : literalsOf(x[0], [](double v) { return v; })[output];
      const double lost =
          output == 1 ? 0x1.4p-123 : 0x1p-124;  // x * 0.1 may be 0, of which 10 times as much is missing
      return std::fabs(got - wanted) <= 0x1p-44 * scale + 0x1.02p-24 * std::fabs(wanted) + lost;
    }
    default: break;
  }
  if (!std::isfinite(x[0])) return true;  // what is infinite times a literal 0
  const auto toFloat = [](double v) { return static_cast<double>(static_cast<float>(v)); };
  const auto flushed = [](double v) {
    return std::fabs(v) < 0x1p-126 ? std::copysign(0.0, v) : static_cast<double>(static_cast<float>(v));
  };
  return judge.equals(static_cast<float>(literalsOf(x[0], toFloat)[output]), got) ||
         (judge.arithmetic.flushesDenormals &&
          judge.equals(static_cast<float>(literalsOf(x[0], flushed)[output]), got)) ||
         (output == 3 && got == 0);
}

bool acceptsRounding(const Judge& judge, Arguments x, std::size_t output, double got) {
  const double wanted =
      std::array{std::floor(x[0]), std::trunc(x[0]), std::ceil(x[0]), std::nearbyint(x[0])}[output];
  return judge.isRounded(wanted, got);
}

bool acceptsParts(const Judge& judge, Arguments x, std::size_t output, double got) {
  const bool isWide =
      judge.options.precision == sk::Precision::Double || judge.options.precision == sk::Precision::Extended;
  switch (output) {
    case 0: {
      const auto wanted = static_cast<float>(x[0] - std::floor(x[0]));
      const float most = isWide ? 1 : 0x1.fffffep-1F;  // a double below 1 is rounded to 1
      return judge.equals(std::isnan(wanted) ? wanted : std::min(wanted, most), got);
    }
    case 1:
      return isSame(got, x[0] > 0           ? 1
                         : x[0] < 0         ? -1
                         : std::isnan(x[0]) ? 0
                                            : x[0]) ||
             (x[0] == 0 && got == 0 && !std::signbit(got));
    case 2:
      return isSame(got, std::fabs(x[0])) ||
             (judge.arithmetic.flushesDenormals && isDenormal(x[0]) && isSame(got, 0));
    default:
      return judge.equals(static_cast<float>((std::isnan(x[0]) ? 0 : std::clamp(x[0], 0.0, 1.0)) + 0.0),
                          got + 0.0);
  }
}

/// IEEE 754's minNum and maxNum, with -0 below 0.
double lesser(double a, double b) { return a == b && std::signbit(a) ? a : a == b ? b : std::fmin(a, b); }
double greater(double a, double b) { return a == b && std::signbit(a) ? b : a == b ? a : std::fmax(a, b); }

bool acceptsOrder(const Judge& judge, Arguments x, std::size_t output, double got) {
  const double wanted = output == 0   ? lesser(x[0], x[1])
                        : output == 1 ? greater(x[0], x[1])
                        : output == 2 ? lesser(greater(x[0], x[1]), x[2])
                                      : (x[1] < x[0] ? 0.0 : 1.0);
  return judge.equals(static_cast<float>(wanted), got);
}
bool acceptsWideOrder(const Judge& judge, Arguments x, std::size_t output, double got) {
  if (output == 2) return got == (x[0] > 0 ? 1 : x[0] < 0 ? -1 : 0);
  return judge.equalsDouble(output == 0 ? lesser(x[0], x[1]) : greater(x[0], x[1]), got);
}

bool acceptsMixes(const Judge& judge, Arguments x, std::size_t output, double got) {
  if (!std::isfinite(x[0]) || !std::isfinite(x[1])) return true;
  const double wanted = output == 0 ? x[0] : output == 1 ? x[1] : x[1] < x[0] ? x[0] : x[1];
  if (judge.equals(static_cast<float>(wanted), got)) return true;
  // A comparison takes denormal numbers as 0, and a sum does not.
  const auto isTiny = [](double v) { return std::fabs(v) < 0x1p-126; };
  return judge.arithmetic.flushesDenormals && output == 2 && isTiny(x[0]) && isTiny(x[1]) &&
         judge.equals(static_cast<float>(x[1] < x[0] ? x[1] : x[0]), got);
}

template <class Int>
bool acceptsIntegers(const Judge&, Arguments x, std::size_t output, double got) {
  const auto a = static_cast<Int>(x[0]), b = static_cast<Int>(x[1]);
  const auto u = static_cast<std::uint32_t>(a), v = static_cast<std::uint32_t>(b);
  const bool overflows =
      std::is_signed_v<Int> && a == std::numeric_limits<Int>::min() && b == static_cast<Int>(-1);
  Int wanted = 0;
  switch (output) {
    case 0: wanted = static_cast<Int>(u * v - u + v); break;
    case 1: wanted = b == 0 || overflows ? a : a / b; break;
    case 2: wanted = b == 0 || overflows ? 0 : a % b; break;
    default: wanted = static_cast<Int>(u << (v & 31U)) ^ static_cast<Int>(a >> (v & 31U));
  }
  return got == static_cast<double>(wanted);
}

template <class Int>
double saturated(double x) {
  using Limits = std::numeric_limits<Int>;
  return std::isnan(x) ? 0
                       : std::clamp(std::trunc(x), static_cast<double>(Limits::min()),
                                    static_cast<double>(Limits::max()));
}
bool acceptsConversions(const Judge&, Arguments x, std::size_t output, double got) {
  if (output == 1) return got == saturated<std::uint32_t>(x[0]);
  const double whole = saturated<std::int32_t>(x[0]);
  return got == (output == 0 ? whole : static_cast<double>(static_cast<float>(whole)));
}
bool acceptsWideConversions(const Judge& judge, Arguments x, std::size_t output, double got) {
  if (output == 0) return got == saturated<std::int32_t>(x[0]);
  if (output == 1) return got == saturated<std::uint32_t>(x[0]);
  return judge.equals(static_cast<float>(output == 2 ? x[0] : toHalf(x[0])), got);
}

/// The float nearest to k / n, where k is the integer nearest to x * n, or to the float nearest to that.
bool isNormalized(const MapJudge& judge, double x, double least, double n, double got) {
  if (std::isnan(x)) return true;
  const double product = std::clamp(x, least, 1.0) * n;
  for (const double one : {product, static_cast<double>(static_cast<float>(product))}) {
    const auto nearest = static_cast<float>(std::nearbyint(one) / n);
    if (judge.isQuotient(nearest, n, got) ||
        std::fabs(got - static_cast<double>(nearest)) <= 0x1p-24 * std::fabs(static_cast<double>(nearest)))
      return true;
  }
  return std::fabs(product - std::floor(product) - 0.5) < 0x1p-30 && std::fabs(got * n - product) < 0.51;
}
bool acceptsNarrow(const Judge& judge, Arguments x, std::size_t output, double got) {
  switch (output) {
    case 0: return judge.equals(static_cast<float>(toHalf(x[0])), got);
    case 1: return isNormalized(judge, x[0], 0, 255, got);
    case 2: return isNormalized(judge, x[0], 0, 65535, got);
    default: return isNormalized(judge, x[0], -1, 127, got);
  }
}

template <const auto& kernel, class In, class Out>
Operation map(std::string_view name, decltype(Operation::accepts) accepts, bool isForReals = true) {
  bool hasDoubles = false;
  for (const Parameter& parameter : In::parameters())
    hasDoubles = hasDoubles || parameter.element == Element::Double;
  return {.name = name,
          .kind = Kind::Map,
          .inputs = In::parameters(),
          .outputs = Out::elements(),
          .folds = {},
          .startsFromZero = false,
          .hasDoubles = hasDoubles,
          .call = callKernel<kernel, In, Out>,
          .accepts = accepts,
          .addTerms = nullptr,
          .isForReals = isForReals};
}

template <class T, Data data = Data::Arguments>
using One = Inputs<Elements<T, data>>;
template <class T, Data data = Data::Arguments>
using Two = Inputs<Elements<T, data>, Elements<T, data>>;
template <class T, Data data = Data::Arguments>
using Three = Inputs<Elements<T, data>, Elements<T, data>, Elements<T, data>>;
using F2 = Outputs<float, float>;
using F3 = Outputs<float, float, float>;
using F4 = Outputs<float, float, float, float>;
using D2 = Outputs<double, double>;
using D3 = Outputs<double, double, double>;

}  // namespace

std::vector<Operation> mapOperations() {
  namespace k = adversary;
  return {
      map<k::circular, One<float, Data::Angles>, F3>("circular", acceptsFunctions<circular>),
      map<k::arcs, One<float, Data::Fractions>, F3>("arcs", acceptsFunctions<arcs>),
      map<k::hyperbolic, One<float>, F3>("hyperbolic", acceptsFunctions<hyperbolic>),
      map<k::areas, One<float, Data::Fractions>, F3>("areas", acceptsFunctions<areas>),
      map<k::exponentials, One<float>, F2>("exponentials", acceptsFunctions<exponentials>),
      map<k::logarithms, One<float>, F3>("logarithms", acceptsFunctions<logarithms>),
      map<k::near0, One<float>, F2>("near0", acceptsFunctions<near0>),
      map<k::errors, One<float>, F2>("errors", acceptsFunctions<errors>),
      map<k::roots, One<float>, F3>("roots", acceptsFunctions<roots>),
      map<k::powers, Two<float>, F3>("powers", acceptsPowers),
      map<k::remainders, Two<float>, F2>("remainders", acceptsRemainders),
      map<k::lengths, One<sk::float3>, Outputs<float, sk::float3>>("lengths", acceptsLengths),
      map<k::wideCircular, One<double, Data::Angles>, D3>("wideCircular", acceptsWide<circular>),
      map<k::wideArcs, One<double, Data::Fractions>, D3>("wideArcs", acceptsWide<arcs>),
      map<k::wideHyperbolic, One<double>, D3>("wideHyperbolic", acceptsWide<hyperbolic>),
      map<k::wideAreas, One<double, Data::Fractions>, D3>("wideAreas", acceptsWide<areas>),
      map<k::wideExponentials, One<double>, D2>("wideExponentials", acceptsWide<exponentials>),
      map<k::wideLogarithms, One<double>, D3>("wideLogarithms", acceptsWide<logarithms>),
      map<k::wideNear0, One<double>, D3>("wideNear0", acceptsWide<near0>),
      map<k::wideErrors, One<double>, D2>("wideErrors", acceptsWide<errors>),
      map<k::widePowers, Two<double>, D3>("widePowers", acceptsWidePowers),
      map<k::operators, Two<float, Data::Terms>, F4>("operators", acceptsOperators),
      map<k::wideOperators, Two<double, Data::Terms>, Outputs<double, double, double, double>>(
          "wideOperators", acceptsWideOperators),
      map<k::fused, Three<float, Data::Terms>, F3>("fused", acceptsFused),
      map<k::literals, One<float>, F4>("literals", acceptsLiterals),
      map<k::rounding, One<float>, F4>("rounding", acceptsRounding),
      map<k::parts, One<float>, F4>("parts", acceptsParts),
      map<k::order, Three<float>, F4>("order", acceptsOrder),
      map<k::wideOrder, Two<double>, D3>("wideOrder", acceptsWideOrder),
      map<k::mixes, Two<float>, F3>("mixes", acceptsMixes),
      map<k::integers, Two<std::int32_t, Data::Integers>,
          Outputs<std::int32_t, std::int32_t, std::int32_t, std::int32_t>>(
          "integers", acceptsIntegers<std::int32_t>, false),
      map<k::unsignedIntegers, Two<std::uint32_t, Data::Integers>,
          Outputs<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>>(
          "unsignedIntegers", acceptsIntegers<std::uint32_t>, false),
      map<k::conversions, One<float>, Outputs<std::int32_t, std::uint32_t, float>>("conversions",
                                                                                   acceptsConversions),
      map<k::wideConversions, One<double>, Outputs<std::int32_t, std::uint32_t, float, float>>(
          "wideConversions", acceptsWideConversions),
      map<k::narrow, One<float, Data::Fractions>, F4>("narrow", acceptsNarrow),
  };
}

}  // namespace fuzz::numbers
