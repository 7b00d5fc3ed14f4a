// SPDX-License-Identifier: MIT
//
// Closed intervals of real numbers, with doubles as ends. Every operation encloses the exact result: ends are rounded outward.
// An end that is infinite says that nothing is known on that side.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace skc::bounds {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double largestDouble = std::numeric_limits<double>::max();

/// At most the exact result of an operation that rounds to nearest gave x; -infinity for NaN.
inline double roundedDown(double x, double relative = 0x1p-52) {
  const double lower = x - (std::fabs(x) * relative + 0x1p-1074);
  if (lower == lower) return lower;
  return x > 0 ? largestDouble : -infinity;
}
/// At least it; infinity for NaN.
inline double roundedUp(double x, double relative = 0x1p-52) { return -roundedDown(-x, relative); }

/// True for a power of 2: there, the errors of operations double, and an end that is exact must not move past it.
inline bool isPowerOf2(double x) { return (std::bit_cast<std::uint64_t>(x) & 0xfffffffffffffu) == 0; }

// A sum that is 0 is exact, and so is a product with 0: an end of 0 keeps its sign.
inline double sumDown(double x, double y) {
  const double sum = x + y;
  if (sum == 0) return 0;
  if (isPowerOf2(sum)) {
    const double part = sum - x;
    if ((x - (sum - part)) + (y - part) == 0) return sum;
  }
  return roundedDown(sum);
}
inline double sumUp(double x, double y) { return -sumDown(-x, -y); }
inline double productDown(double x, double y) {
  if (x == 0 || y == 0) return 0;
  const double product = x * y;
  if (isPowerOf2(product) && std::fabs(product) > 0x1p-900 && std::fma(x, y, -product) == 0) return product;
  return roundedDown(product);
}
inline double productUp(double x, double y) { return -productDown(-x, y); }
inline double quotientDown(double x, double y) {
  if (x == 0) return 0;
  const double quotient = x / y;
  if (isPowerOf2(quotient) && std::fabs(quotient) > 0x1p-900 && std::fma(quotient, y, -x) == 0)
    return quotient;
  return roundedDown(quotient);
}
inline double quotientUp(double x, double y) { return -quotientDown(-x, y); }

struct Interval {
  double low = 0, high = 0;

  static constexpr Interval point(double x) { return {x, x}; }
  static constexpr Interval whole() { return {-infinity, infinity}; }

  bool isFinite() const { return low > -infinity && high < infinity; }
  bool isEmpty() const { return !(low <= high); }
  bool isPoint() const { return low == high; }
  bool contains(double x) const { return low <= x && x <= high; }
  /// The largest magnitude.
  double magnitude() const { return std::max(std::fabs(low), std::fabs(high)); }
  /// The smallest magnitude.
  double smallest() const { return contains(0) ? 0 : std::min(std::fabs(low), std::fabs(high)); }
  /// A number between the ends.
  double middle() const { return isPoint() ? low : std::clamp(low / 2 + high / 2, low, high); }
  double width() const { return high - low; }
};

inline Interval operator-(Interval x) { return {-x.high, -x.low}; }
inline Interval operator+(Interval x, Interval y) { return {sumDown(x.low, y.low), sumUp(x.high, y.high)}; }
inline Interval operator-(Interval x, Interval y) { return x + -y; }

inline Interval operator*(Interval x, Interval y) {
  if (x.low >= 0 && y.low >= 0) return {productDown(x.low, y.low), productUp(x.high, y.high)};
  return {std::min(std::min(productDown(x.low, y.low), productDown(x.low, y.high)),
                   std::min(productDown(x.high, y.low), productDown(x.high, y.high))),
          std::max(std::max(productUp(x.low, y.low), productUp(x.low, y.high)),
                   std::max(productUp(x.high, y.low), productUp(x.high, y.high)))};
}

/// Unknown if y contains 0.
inline Interval operator/(Interval x, Interval y) {
  if (y.contains(0) || y.isEmpty()) return Interval::whole();
  return {std::min(std::min(quotientDown(x.low, y.low), quotientDown(x.low, y.high)),
                   std::min(quotientDown(x.high, y.low), quotientDown(x.high, y.high))),
          std::max(std::max(quotientUp(x.low, y.low), quotientUp(x.low, y.high)),
                   std::max(quotientUp(x.high, y.low), quotientUp(x.high, y.high)))};
}

inline Interval square(Interval x) {
  const double small = x.smallest(), large = x.magnitude();
  return {productDown(small, small), productUp(large, large)};
}

inline Interval absolute(Interval x) { return {x.smallest(), x.magnitude()}; }
inline Interval smaller(Interval x, Interval y) { return {std::min(x.low, y.low), std::min(x.high, y.high)}; }
inline Interval larger(Interval x, Interval y) { return {std::max(x.low, y.low), std::max(x.high, y.high)}; }
inline Interval hull(Interval x, Interval y) { return {std::min(x.low, y.low), std::max(x.high, y.high)}; }
inline Interval intersection(Interval x, Interval y) {
  return {std::max(x.low, y.low), std::min(x.high, y.high)};
}
/// All numbers that are at most `distance` from one of x.
inline Interval widened(Interval x, double distance) {
  if (distance == 0) return x;
  return {sumDown(x.low, -distance), sumUp(x.high, distance)};
}

/// The power of 2 that is not above the magnitude of a finite, normal x.
inline double powerBelow(double x) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & 0x7ff0000000000000u);
}

}  // namespace skc::bounds
