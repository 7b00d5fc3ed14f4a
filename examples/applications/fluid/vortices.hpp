// SPDX-License-Identifier: MIT
//
// G. Taylor and A. Green's vortices (1937) on a periodic square with sides of 2 pi, carried along by a wind: an exact solution, whose
// convection is not balanced by pressure alone.
#pragma once

#include <cmath>
#include <vector>

#include "flow.hpp"

namespace fluid {

inline constexpr double twoPi = 6.28318530717958647692;

struct Vortices {
  double viscosity = 0.02;
  double windX = 1.0, windY = 0.5;

  double velocity(int axis, double x, double y, double t) const {
    const double a = x - windX * t, b = y - windY * t, decay = std::exp(-2.0 * viscosity * t);
    if (axis == 0) return windX - std::cos(a) * std::sin(b) * decay;
    return axis == 1 ? windY + std::sin(a) * std::cos(b) * decay : 0.0;
  }
};

/// A grid for them, of n x n cells, or n x n x depth.
inline Model vortexModel(const Vortices& vortices, std::int64_t n, Scheme scheme, sk::Precision precision,
                         std::int64_t depth = 1) {
  Model m;
  m.cells = {n, n, depth};
  m.spacing = twoPi / static_cast<double>(n);
  m.scheme = scheme;
  m.precision = precision;
  m.tolerance = precision == sk::Precision::Double ? 1e-9 : 1e-6;
  if (vortices.viscosity > 0.0) m.viscosity = Viscosity{vortices.viscosity};
  return m;
}

/// At the faces along an axis.
inline std::vector<double> velocitiesOf(const Vortices& vortices, const Model& m, int axis, double time) {
  std::vector<double> values;
  for (std::int64_t z = 0; z < m.cells[2]; ++z) {
    for (std::int64_t y = 0; y < m.cells[1]; ++y) {
      for (std::int64_t x = 0; x < m.cells[0]; ++x) {
        Triple p = m.centre({x, y, z});
        p[static_cast<std::size_t>(axis)] -= 0.5 * m.spacing;
        values.push_back(vortices.velocity(axis, p[0], p[1], time));
      }
    }
  }
  return values;
}

/// The root mean square of the difference from the exact velocity.
inline double errorOf(const Vortices& vortices, const Flow& flow) {
  double sum = 0.0, count = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    const std::vector<double> exact = velocitiesOf(vortices, flow.model(), axis, flow.time());
    const std::vector<double> found = flow.velocity(axis);
    for (std::size_t i = 0; i < exact.size(); ++i) sum += (found[i] - exact[i]) * (found[i] - exact[i]);
    count += static_cast<double>(exact.size());
  }
  return std::sqrt(sum / count);
}

/// A flow at time 0, free of divergence on its grid.
inline Flow vortexFlow(sk::Device& device, const Vortices& vortices, const Model& model) {
  Flow flow(device, model);
  for (int axis = 0; axis < 2; ++axis) flow.writeVelocity(axis, velocitiesOf(vortices, model, axis, 0.0));
  flow.project();
  return flow;
}

}  // namespace fluid
