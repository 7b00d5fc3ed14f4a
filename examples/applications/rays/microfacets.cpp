// SPDX-License-Identifier: MIT
#include "microfacets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/vec.hpp"

namespace rays {
namespace {

using examples::Vector;

/// Smith's function, of a direction with this cosine.
double lambda(double cosine, double alpha) {
  const double slope = alpha * alpha * (1 - cosine * cosine) / (cosine * cosine);
  return (std::sqrt(1 + slope) - 1) / 2;
}

/// A normal among those that `v` sees, as `visibleNormal` of scattering.sk.
Vector visibleNormal(const Vector& v, double alpha, double z, double angle) {
  const Vector s = normalized(Vector{alpha * v.x, alpha * v.y, v.z});
  const double r = std::sqrt(std::max(1 - z * z, 0.0));
  return normalized(
      Vector{alpha * (r * std::cos(angle) + s.x), alpha * (r * std::sin(angle) + s.y), z + s.z});
}

}  // namespace

double reflectedOnce(double cosine, double alpha, double normal, int side) {
  const Vector v = {std::sqrt(1 - cosine * cosine), 0, cosine};
  const double stretched = cosine / std::hypot(alpha * v.x, cosine), hidden = lambda(cosine, alpha);
  double sum = 0.0;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      // Rows are shifted by multiples of the golden ratio, so that the edge of what leaves the surface falls between points evenly.
      const double shift = 0.5 + j * std::numbers::phi;
      const double z = 1 - (i + shift - std::floor(shift)) / side * (1 + stretched);
      const Vector h = visibleNormal(v, alpha, z, std::numbers::pi * (j + 0.5) / side);
      const double vh = dot(v, h), outward = 2 * vh * h.z - v.z;
      if (outward <= 0) continue;
      const double fresnel = normal + (1 - normal) * std::pow(std::max(1 - vh, 0.0), 5);
      sum += fresnel * (1 + hidden) / (1 + hidden + lambda(std::min(outward, 1.0), alpha));
    }
  }
  return sum / (double(side) * side);
}

double reflectedInAll(double cosine, double alpha, double normal) {
  const double white = reflectedOnce(cosine, alpha);
  return reflectedOnce(cosine, alpha, normal) * (1 + normal * (1 - white) / white);
}

}  // namespace rays
