// SPDX-License-Identifier: MIT
#include "numbers/judge.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace fuzz::numbers {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<float>::max();

numerics::FunctionOracle& oracle() {
  static numerics::FunctionOracle made;
  return made;
}

/// The function's value, rounded to a double.
double valueOf(numerics::Unary function, double x) {
  mpfr_t value;
  mpfr_init2(value, 53);
  mpfr_set_d(value, x, MPFR_RNDN);
  function(value, value, MPFR_RNDN);
  const double result = mpfr_get_d(value, MPFR_RNDN);
  mpfr_clear(value);
  return result;
}

double valueOf(numerics::Binary function, double x, double y) {
  mpfr_t value, second;
  mpfr_inits2(53, value, second, nullptr);
  mpfr_set_d(value, x, MPFR_RNDN);
  mpfr_set_d(second, y, MPFR_RNDN);
  function(value, value, second, MPFR_RNDN);
  const double result = mpfr_get_d(value, MPFR_RNDN);
  mpfr_clears(value, second, nullptr);
  return result;
}

bool isSmallest(double x) { return std::fabs(x) <= 0x1.000002p-126; }

}  // namespace

double toHalf(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  const double unit = std::ldexp(1.0, std::max(std::ilogb(x), -14) - 10);
  const double rounded = std::nearbyint(x / unit) * unit;
  return std::fabs(rounded) > 65504 ? std::copysign(infinity, x) : std::copysign(rounded, x);
}

double toPair(double x) {
  const auto high = static_cast<float>(x);
  const auto low = static_cast<double>(static_cast<float>(x - static_cast<double>(high)));
  const bool isOne = !std::isfinite(high) || std::fabs(low) < 0x1p-126;  // keeps the sign of a zero
  return isOne ? static_cast<double>(high) : static_cast<double>(high) + low;
}

bool isDenormal(double x) { return x != 0 && std::fabs(x) < 0x1p-126; }
bool mayBeFlushed(double x) { return x != 0 && std::fabs(x) <= 0x1p-126; }

bool isSame(double a, double b) {
  return std::isnan(a) ? std::isnan(b) : std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool MapJudge::equals(float wanted, double got) const {
  if (isSame(wanted, got)) return true;
  return arithmetic.flushesDenormals && isDenormal(wanted) && isSame(got, std::copysign(0.0, wanted));
}

bool MapJudge::isAnyQuotient(double divisor) const {
  return !arithmetic.roundsQuotients && std::fabs(divisor) > 0x1p126;
}

bool MapJudge::isQuotient(float wanted, double divisor, double got) const {
  if (equals(wanted, got) || isAnyQuotient(divisor)) return true;
  if (arithmetic.roundsQuotients || wanted == 0 || !std::isfinite(wanted)) return false;
  const double unit = std::ldexp(1.0, std::max(std::ilogb(wanted), -126) - 23);
  return std::fabs(got - static_cast<double>(wanted)) <= 2.5 * unit;
}

bool MapJudge::equalsDouble(double wanted, double got) const {
  if (arithmetic.hasPairs) {
    if (std::isnan(wanted) || std::isnan(got)) return std::isnan(wanted) && std::isnan(got);
    const double nearest = toPair(wanted);
    if (std::fabs(got - nearest) <= std::max(std::fabs(nearest) * 0x1p-44, 0x1p-124) || got == nearest)
      return true;
    return std::fabs(wanted) > 0x1p126 && std::isinf(got);
  }
  return isSame(wanted, got);
}

bool MapJudge::isRounded(double wanted, double got, double scale) const {
  switch (options.precision) {
    case sk::Precision::Half: return equals(static_cast<float>(toHalf(wanted)), got);
    case sk::Precision::Extended: {
      const auto nearest = static_cast<float>(wanted);
      if (equals(nearest, got)) return true;
      if (std::isnan(wanted) || std::isnan(got)) return false;
      if (std::isinf(got)) return got * wanted > 0 && std::fabs(wanted) > 0x1p126;  // a part may overflow
      if (got == 0 && nearest == 0) return arithmetic.flushesDenormals && wanted != 0;
      const double unit = std::ldexp(1.0, std::max(std::ilogb(wanted), -126) - 23);
      const double own = 0x1p-44 * std::max(std::fabs(wanted), scale);
      const double lost = arithmetic.isNative ? 0 : 0x1p-124;  // numbers below 3e-24 have fewer bits
      return std::fabs(got - wanted) <= 0.5 * unit + own + lost;
    }
    default: return equals(static_cast<float>(wanted), got);
  }
}

bool MapJudge::accepts(const char* name, double error, double nearest, double got) const {
  const bool isWide =
      options.precision == sk::Precision::Double || options.precision == sk::Precision::Extended;
  const double bound = isWide ? 0.51 : boundOf(name, sk::BoundedType::Float, arithmetic.isNative);
  if (error <= bound + (arithmetic.roundsQuotients ? 0 : unroundedQuotient)) return true;
  if (!arithmetic.flushesDenormals) return false;
  if (options.precision == sk::Precision::Extended && std::fabs(nearest) < 0x1p-78 &&
      std::fabs(got - nearest) <= 0x1p-124)
    return true;
  return isSmallest(nearest) && got == 0 && std::signbit(got) == std::signbit(nearest);
}

bool MapJudge::isFunction(const char* name, numerics::Unary function, double x, double got) const {
  const double error = oracle().error(function, static_cast<float>(x), static_cast<float>(got));
  return error == 0 || accepts(name, error, valueOf(function, x), got);
}

bool MapJudge::isFunction(const char* name, numerics::Binary function, double x, double y, double got) const {
  const double error =
      oracle().error(function, static_cast<float>(x), static_cast<float>(y), static_cast<float>(got));
  return error == 0 || accepts(name, error, valueOf(function, x, y), got);
}

bool MapJudge::acceptsWide(const char* name, double error, double nearest, double got) const {
  if (arithmetic.isNative) return error <= boundOf(name, sk::BoundedType::Double, true);
  if (std::isnan(nearest) || std::isnan(got)) return std::isnan(nearest) && std::isnan(got);
  const double most = arithmetic.hasPairs ? 0x1.fffffcp127 : std::numeric_limits<double>::max();
  if (std::fabs(nearest) >= most) return std::fabs(got) >= most && std::signbit(got) == std::signbit(nearest);
  if (arithmetic.hasPairs && std::fabs(nearest) < 0x1p-78) return std::fabs(got - nearest) <= 0x1p-124;
  if (std::fabs(nearest) < 0x1p-1022) return std::fabs(got - nearest) <= 0x1p-1022;
  const double relative = std::fabs((got - nearest) / nearest);
  // `nearest` is rounded itself.
  return relative <=
         (boundOf(name, arithmetic.hasPairs ? sk::BoundedType::Pair : sk::BoundedType::Double, false) + 0.5) *
             0x1p-53;
}

bool MapJudge::isWideFunction(const char* name, numerics::Unary function, double x, double got) const {
  const double error = oracle().error(function, x, got);
  return error == 0 || acceptsWide(name, error, valueOf(function, x), got);
}

bool MapJudge::isWideFunction(const char* name, numerics::Binary function, double x, double y,
                              double got) const {
  const double error = oracle().error(function, x, y, got);
  return error == 0 || acceptsWide(name, error, valueOf(function, x, y), got);
}

void SumJudge::add(double a, double b) {
  ++terms_;
  const double product = a * b;  // never overflows or vanishes: both are floats, or doubles of middling size
  hasOnlyNegativeZeros_ = hasOnlyNegativeZeros_ && product == 0 && std::signbit(product);
  if (mayBeFlushed(a) || mayBeFlushed(b) || mayBeFlushed(product)) {
    flushed_ += std::isfinite(product) ? std::fabs(product) : 0;
    mayBeNan_ = mayBeNan_ || !std::isfinite(product);
  }
  if (std::isnan(product)) {
    hasNan_ = true;
  } else if (std::isinf(product)) {
    (product > 0 ? hasPositive_ : hasNegative_) = true;
  } else {
    sum_.addProduct(a, b);
  }
}

std::string SumJudge::mistake(double got, SumFacts facts, const Arithmetic& arithmetic,
                              bool startsFromZero) const {
  if (isUnknown_) return {};
  const bool isExact = facts.accumulate == sk::Accumulate::Exact && !facts.areDoubles;
  const bool mayFlush = arithmetic.flushesDenormals && !isExact;
  if (mayFlush && mayBeNan_) return {};
  const auto differs = [&](double wanted, const char* what) {
    return fmt::format("{}, {} {}", shown(got), what, shown(wanted));
  };
  if (hasNan_ || (hasPositive_ && hasNegative_))
    return std::isnan(got) ? "" : differs(std::numeric_limits<double>::quiet_NaN(), "not");
  facts.sum = sum_.value();
  facts.magnitude = sum_.magnitude();
  facts.terms = terms_;
  const bool arePairs = !arithmetic.isNative && (facts.areDoubles ? arithmetic.hasPairs : facts.isWide());
  const double most = !facts.areDoubles ? 0x1p126 : arePairs ? 0x1p120 : 0x1p1000;
  const bool mayOverflow = !isExact && facts.magnitude >= most;
  if (hasPositive_ || hasNegative_) {
    const double wanted = hasPositive_ ? infinity : -infinity;
    return got == wanted || (mayOverflow && !std::isfinite(got)) ? "" : differs(wanted, "not");
  }
  if (mayOverflow) return {};
  if (isExact) {
    double wanted = sum_.rounded();
    if (terms_ > 0 && hasOnlyNegativeZeros_ && !startsFromZero)
      wanted = -0.0;
    else if (wanted == 0 && sum_.value() == 0)
      wanted = 0;
    return isSame(got, wanted) ? "" : differs(wanted, "not");
  }
  if (!std::isfinite(got)) return differs(facts.sum, "not");
  const double ofPairs = arePairs ? terms_ * 0x1p-122 : 0;
  const double bound = boundOfSum(facts, arithmetic) + ofPairs + (mayFlush ? flushed_ : 0);
  const double error = sum_.errorOf(got);
  if (error <= bound) return {};
  return fmt::format(
      "{}, off by {:.3g} from {}, where {:.3g} is promised for {} terms whose magnitudes add up to {:.4g}",
      shown(got), error, shown(facts.sum), bound, terms_, facts.magnitude);
}

}  // namespace fuzz::numbers
