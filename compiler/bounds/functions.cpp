// SPDX-License-Identifier: MIT
#include "bounds/functions.hpp"

#include <array>
#include <numbers>

namespace skc::bounds {
namespace {

constexpr std::array<std::string_view, 26> spellings = {
#define SKC_BOUNDED_FUNCTION(Name, spelling) spelling,
#include "bounds/functions.def"
#undef SKC_BOUNDED_FUNCTION
};

constexpr double room = 0x1p-49;  // of an end that the C library computed

double libraryDown(double x) { return x == 0 ? -0x1p-1074 : roundedDown(x, room); }
double libraryUp(double x) { return -libraryDown(-x); }

/// The values of a function that does not decrease.
template <class F>
Interval rising(Interval x, F f) {
  return {libraryDown(f(x.low)), libraryUp(f(x.high))};
}
template <class F>
Interval falling(Interval x, F f) {
  return {libraryDown(f(x.high)), libraryUp(f(x.low))};
}
Interval within(Interval x, double low, double high) {
  return {std::max(x.low, low), std::min(x.high, high)};
}

/// True unless no number phase + k * period, for an integer k, is in x; true in doubtful cases.
bool mayContain(Interval x, double phase, double period) {
  const double slack = 1e-12 * (1 + x.magnitude());
  const double k = std::ceil((x.low - slack - phase) / period);
  return phase + k * period <= x.high + slack;
}

Interval cosine(Interval x) {
  constexpr double turn = 2 * std::numbers::pi;
  if (!(x.magnitude() < 1e9) || x.width() >= turn) return {-1, 1};
  const double a = std::cos(x.low), b = std::cos(x.high);
  Interval y = {libraryDown(std::min(a, b)), libraryUp(std::max(a, b))};
  if (mayContain(x, 0, turn)) y.high = 1;
  if (mayContain(x, std::numbers::pi, turn)) y.low = -1;
  return within(y, -1, 1);
}

Interval sine(Interval x) {
  constexpr double turn = 2 * std::numbers::pi;
  if (!(x.magnitude() < 1e9) || x.width() >= turn) return {-1, 1};
  const double a = std::sin(x.low), b = std::sin(x.high);
  Interval y = {libraryDown(std::min(a, b)), libraryUp(std::max(a, b))};
  if (mayContain(x, std::numbers::pi / 2, turn)) y.high = 1;
  if (mayContain(x, -std::numbers::pi / 2, turn)) y.low = -1;
  return within(y, -1, 1);
}

bool tangentIsDefined(Interval x) {
  return x.magnitude() < 1e9 && !mayContain(x, std::numbers::pi / 2, std::numbers::pi);
}

Interval root(Interval x) {
  return {x.low <= 0 ? 0 : libraryDown(std::sqrt(x.low)), libraryUp(std::sqrt(std::max(x.high, 0.0)))};
}

Interval constant(double x) { return {libraryDown(x), libraryUp(x)}; }

const Interval one = Interval::point(1);

/// 1 / sqrt(x), of a positive x.
Interval inverseRoot(Interval x) {
  const Interval y = root(x);
  return y.low > 0 ? one / y : Interval{y.high > 0 ? quotientDown(1, y.high) : 0, infinity};
}

}  // namespace

std::string_view spelling(UnaryFunction function) { return spellings[static_cast<std::size_t>(function)]; }

bool isDefined(UnaryFunction function, Interval x) {
  if (x.isEmpty()) return false;
  switch (function) {
    case UnaryFunction::Sqrt: return x.low >= 0;
    case UnaryFunction::InverseSqrt:
    case UnaryFunction::Log:
    case UnaryFunction::Log2:
    case UnaryFunction::Log10: return x.low > 0;
    case UnaryFunction::Log1p: return x.low > -1;
    case UnaryFunction::Tan: return tangentIsDefined(x);
    case UnaryFunction::Asin:
    case UnaryFunction::Acos: return x.low >= -1 && x.high <= 1;
    case UnaryFunction::Acosh: return x.low >= 1;
    case UnaryFunction::Atanh: return x.low > -1 && x.high < 1;
    case UnaryFunction::Exp:
    case UnaryFunction::Exp2:
    case UnaryFunction::Expm1:
    case UnaryFunction::Sin:
    case UnaryFunction::Cos:
    case UnaryFunction::Atan:
    case UnaryFunction::Sinh:
    case UnaryFunction::Cosh:
    case UnaryFunction::Tanh:
    case UnaryFunction::Asinh:
    case UnaryFunction::Cbrt:
    case UnaryFunction::Erf:
    case UnaryFunction::Erfc:
    case UnaryFunction::Radians:
    case UnaryFunction::Degrees: return true;
  }
  return false;
}

Interval valueOf(UnaryFunction function, Interval x) {
  if (x.isEmpty()) return Interval::whole();
  switch (function) {
    case UnaryFunction::Sqrt: return root(x);
    case UnaryFunction::InverseSqrt: return inverseRoot(x);
    case UnaryFunction::Exp: return larger(rising(x, [](double v) { return std::exp(v); }), {0, 0});
    case UnaryFunction::Exp2: return larger(rising(x, [](double v) { return std::exp2(v); }), {0, 0});
    case UnaryFunction::Expm1: return larger(rising(x, [](double v) { return std::expm1(v); }), {-1, -1});
    case UnaryFunction::Log: return rising(within(x, 0, infinity), [](double v) { return std::log(v); });
    case UnaryFunction::Log2: return rising(within(x, 0, infinity), [](double v) { return std::log2(v); });
    case UnaryFunction::Log10: return rising(within(x, 0, infinity), [](double v) { return std::log10(v); });
    case UnaryFunction::Log1p: return rising(within(x, -1, infinity), [](double v) { return std::log1p(v); });
    case UnaryFunction::Sin: return sine(x);
    case UnaryFunction::Cos: return cosine(x);
    case UnaryFunction::Tan:
      return tangentIsDefined(x) ? rising(x, [](double v) { return std::tan(v); }) : Interval::whole();
    case UnaryFunction::Asin: return rising(within(x, -1, 1), [](double v) { return std::asin(v); });
    case UnaryFunction::Acos:
      return larger(falling(within(x, -1, 1), [](double v) { return std::acos(v); }), {0, 0});
    case UnaryFunction::Atan: return rising(x, [](double v) { return std::atan(v); });
    case UnaryFunction::Sinh: return rising(x, [](double v) { return std::sinh(v); });
    case UnaryFunction::Cosh:
      return larger(rising(absolute(x), [](double v) { return std::cosh(v); }), {1, 1});
    case UnaryFunction::Tanh: return within(rising(x, [](double v) { return std::tanh(v); }), -1, 1);
    case UnaryFunction::Asinh: return rising(x, [](double v) { return std::asinh(v); });
    case UnaryFunction::Acosh:
      return larger(rising(within(x, 1, infinity), [](double v) { return std::acosh(v); }), {0, 0});
    case UnaryFunction::Atanh: return rising(within(x, -1, 1), [](double v) { return std::atanh(v); });
    case UnaryFunction::Cbrt: return rising(x, [](double v) { return std::cbrt(v); });
    case UnaryFunction::Erf: return within(rising(x, [](double v) { return std::erf(v); }), -1, 1);
    case UnaryFunction::Erfc: return within(falling(x, [](double v) { return std::erfc(v); }), 0, 2);
    case UnaryFunction::Radians: return x * constant(std::numbers::pi / 180);
    case UnaryFunction::Degrees: return x * constant(180 / std::numbers::pi);
  }
  return Interval::whole();
}

Interval slopeOf(UnaryFunction function, Interval x) {
  if (x.isEmpty()) return Interval::whole();
  const auto scaled = [](Interval y, double factor) { return y * constant(factor); };
  const auto overSquareRoot = [](Interval y) { return y.low > 0 ? inverseRoot(y) : Interval{0, infinity}; };
  switch (function) {
    case UnaryFunction::Sqrt: return inverseRoot(within(x, 0, infinity)) * Interval::point(0.5);
    case UnaryFunction::InverseSqrt: {
      const Interval r = inverseRoot(within(x, 0, infinity));
      return -(r * r * r) * Interval::point(0.5);
    }
    case UnaryFunction::Exp: return valueOf(UnaryFunction::Exp, x);
    case UnaryFunction::Exp2: return scaled(valueOf(UnaryFunction::Exp2, x), std::numbers::ln2);
    case UnaryFunction::Expm1: return valueOf(UnaryFunction::Exp, x);
    case UnaryFunction::Log: return one / x;
    case UnaryFunction::Log2: return scaled(one / x, 1 / std::numbers::ln2);
    case UnaryFunction::Log10: return scaled(one / x, 1 / std::numbers::ln10);
    case UnaryFunction::Log1p: return one / (one + x);
    case UnaryFunction::Sin: return cosine(x);
    case UnaryFunction::Cos: return -sine(x);
    case UnaryFunction::Tan: return one + square(valueOf(UnaryFunction::Tan, x));
    case UnaryFunction::Asin: return overSquareRoot(one - square(x));
    case UnaryFunction::Acos: return -overSquareRoot(one - square(x));
    case UnaryFunction::Atan: return one / (one + square(x));
    case UnaryFunction::Sinh: return valueOf(UnaryFunction::Cosh, x);
    case UnaryFunction::Cosh: return valueOf(UnaryFunction::Sinh, x);
    case UnaryFunction::Tanh: return within(one - square(valueOf(UnaryFunction::Tanh, x)), 0, 1);
    case UnaryFunction::Asinh: return inverseRoot(one + square(x));
    case UnaryFunction::Acosh: return overSquareRoot(x.low > 1 ? square(x) - one : Interval{0, infinity});
    case UnaryFunction::Atanh: return one / (one - square(x));
    case UnaryFunction::Cbrt: {
      if (x.contains(0)) return {0, infinity};
      return one / (square(valueOf(UnaryFunction::Cbrt, x)) * Interval::point(3));
    }
    case UnaryFunction::Erf:
      return scaled(valueOf(UnaryFunction::Exp, -square(x)), 2 * std::numbers::inv_sqrtpi);
    case UnaryFunction::Erfc: return -slopeOf(UnaryFunction::Erf, x);
    case UnaryFunction::Radians: return constant(std::numbers::pi / 180);
    case UnaryFunction::Degrees: return constant(180 / std::numbers::pi);
  }
  return Interval::whole();
}

// ---- functions of two numbers ---------------------------------------------------------------------

namespace {

bool isInteger(Interval y) { return y.isPoint() && std::fabs(y.low) < 1e9 && std::floor(y.low) == y.low; }

/// x^n of numbers of any sign.
Interval integerPower(Interval x, double n) {
  const auto power = [n](double v) { return std::pow(v, n); };
  if (n == 0) return one;
  if (n < 0) return one / integerPower(x, -n);
  if (std::fmod(n, 2) == 0) return larger(rising(absolute(x), power), {0, 0});
  return rising(x, power);
}

/// x^y of positive x: it has its extremes at the corners, for it is monotone in each argument where the other is fixed.
Interval cornerPower(Interval x, Interval y) {
  const double a = std::pow(x.low, y.low), b = std::pow(x.low, y.high);
  const double c = std::pow(x.high, y.low), d = std::pow(x.high, y.high);
  const Interval all = {std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d))};
  return {std::max(libraryDown(all.low), 0.0), libraryUp(all.high)};
}

}  // namespace

bool isDefined(BinaryFunction function, Interval x, Interval y) {
  if (x.isEmpty() || y.isEmpty()) return false;
  if (function == BinaryFunction::Hypot) return true;
  // An angle jumps where the first argument changes sign and the second is negative.
  if (function == BinaryFunction::Atan2) return !x.contains(0) || y.low > 0;
  if (x.low > 0) return true;
  if (isInteger(y)) return y.low >= 0 || !x.contains(0);
  return x.low == 0 && y.low > 0;
}

Interval valueOf(BinaryFunction function, Interval x, Interval y) {
  switch (function) {
    case BinaryFunction::Pow:
      if (!isDefined(function, x, y)) return Interval::whole();
      return isInteger(y) ? integerPower(x, y.low) : cornerPower(x, y);
    case BinaryFunction::Hypot: return root(square(x) + square(y));
    case BinaryFunction::Atan2: {
      const Interval turn = {-libraryUp(std::numbers::pi), libraryUp(std::numbers::pi)};
      if (!isDefined(function, x, y)) return turn;
      Interval angle = {infinity, -infinity};
      for (const double s : {x.low, x.high}) {
        for (const double c : {y.low, y.high}) angle = hull(angle, Interval::point(std::atan2(s, c)));
      }
      return {libraryDown(angle.low), libraryUp(angle.high)};
    }
  }
  return Interval::whole();
}

Slopes slopesOf(BinaryFunction function, Interval x, Interval y) {
  switch (function) {
    case BinaryFunction::Pow: {
      if (isInteger(y)) {
        const Interval slope = y.low == 0 ? Interval::point(0) : y * integerPower(x, y.low - 1);
        const bool isConstant = y.isPoint();
        return {slope, isConstant ? Interval::point(0) : Interval::whole()};
      }
      if (!(x.low > 0)) return {Interval::whole(), Interval::whole()};
      return {y * cornerPower(x, y - one), cornerPower(x, y) * valueOf(UnaryFunction::Log, x)};
    }
    case BinaryFunction::Hypot: {
      const Interval length = valueOf(function, x, y);
      const Interval unit = {-1, 1};
      if (!(length.low > 0)) return {unit, unit};
      return {intersection(x / length, unit), intersection(y / length, unit)};
    }
    case BinaryFunction::Atan2: {
      const Interval squares = square(x) + square(y);
      if (!(squares.low > 0)) return {Interval::whole(), Interval::whole()};
      return {y / squares, -(x / squares)};
    }
  }
  return {Interval::whole(), Interval::whole()};
}

}  // namespace skc::bounds
