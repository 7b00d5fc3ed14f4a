// SPDX-License-Identifier: MIT
#include "limits.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace examples {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

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

double diffusionLimit(double rate, double spacing, int dimensions) {
  return rate > 0.0 && dimensions > 0 ? spacing * spacing / (2.0 * dimensions * rate) : unlimited;
}

double reactionLimit(const Reaction& r, int dimensions) {
  const double decay = 4.0 * dimensions * r.diffusionU / (r.spacing * r.spacing) + r.feed;
  return decay > 0.0 ? 2.0 / decay : unlimited;
}

double soundLimit(const Flow& flow, double spacing) {
  const double c2 = flow.sound * flow.sound, h2 = spacing * spacing;
  const double nu = flow.viscosity + flow.damping * flow.sound * spacing;
  if (c2 == 0.0) return diffusionLimit(nu, spacing, 2);
  return (std::sqrt(4.0 * nu * nu + 2.0 * c2 * h2) - 2.0 * nu) / (2.0 * c2);
}

int dimensionsOf(const Grid& grid) {
  return static_cast<int>(grid.width > 1) + static_cast<int>(grid.height > 1) +
         static_cast<int>(grid.depth > 1);
}

std::vector<Limit> limitsOf(const Model& model) {
  const int dimensions = dimensionsOf(model.grid);
  std::vector<Limit> limits;
  if (model.diffusion) {
    limits.push_back({"diffusion", fmt::format("h^2 / {}D", 2 * dimensions),
                      diffusionLimit(model.diffusion->rate, model.grid.spacing, dimensions), model.timeStep});
  }
  if (model.flow) {
    limits.push_back({"flow", "2 c^2 dt^2 + 4 (nu + lambda) dt = h^2",
                      soundLimit(*model.flow, model.grid.spacing), model.timeStep});
  }
  if (model.reaction) {
    limits.push_back({"reaction", fmt::format("2 / ({} Du / h^2 + F)", 4 * dimensions),
                      reactionLimit(*model.reaction, dimensions), model.reaction->timeStep});
  }
  return limits;
}

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
