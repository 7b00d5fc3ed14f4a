// SPDX-License-Identifier: MIT
#include "theory.hpp"

#include <cmath>
#include <numbers>

namespace examples {
namespace {

/// Zero where R = k^4 t^3 is critical (Chandrasekhar's equation 215 of chapter II): its poles, where the tangent has some, are no
/// zeros, so that both sides are multiplied by the cosine.
double characteristic(double k, double t) {
  const double root = std::sqrt(1.0 + t + t * t);
  const double q0 = k * std::sqrt(t - 1.0);
  const double q1 = k * std::sqrt(0.5 * root + 0.5 * (1.0 + 0.5 * t));
  const double q2 = k * std::sqrt(0.5 * root - 0.5 * (1.0 + 0.5 * t));
  const double sqrt3 = std::numbers::sqrt3;
  const double right =
      ((q1 + q2 * sqrt3) * std::sinh(q1) + (q1 * sqrt3 - q2) * std::sin(q2)) / (std::cosh(q1) + std::cos(q2));
  return q0 * std::sin(0.5 * q0) + right * std::cos(0.5 * q0);
}

}  // namespace

double criticalBetweenFreePlates(double k) {
  const double sum = std::numbers::pi * std::numbers::pi + k * k;
  return sum * sum * sum / (k * k);
}

double criticalBetweenRigidPlates(double k) {
  // The first zero above the free plates' number, which is smaller: upwards in small steps, then by halving.
  const auto t = [&](double rayleigh) { return std::cbrt(rayleigh / (k * k * k * k)); };
  double low = criticalBetweenFreePlates(k);
  double high = low;
  while (characteristic(k, t(low)) * characteristic(k, t(high)) > 0.0) high *= 1.01;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (characteristic(k, t(low)) * characteristic(k, t(middle)) > 0.0 ? low : high) = middle;
  }
  return low;
}

}  // namespace examples
