// SPDX-License-Identifier: MIT
#include "reference.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace examples {
namespace {

using Values = std::vector<double>;

/// The largest relative error of one rounding of the model's numbers.
double roundoffOf(sk::Precision precision) {
  switch (precision) {
    case sk::Precision::Default:
    case sk::Precision::Single: return roundoff;
    case sk::Precision::Half: return 0x1p-11;
    case sk::Precision::Extended: return 0x1p-44;
    case sk::Precision::Double: return 0x1p-53;
  }
  return roundoff;
}

/// A step on the host. Indices are of cells; those outside go round, or are answered for by the boundary.
class HostStep {
 public:
  explicit HostStep(const Model& model)
      : m_(model),
        c_(coefficientsOf(model)),
        nx_(model.grid.width),
        ny_(model.grid.height),
        nz_(model.grid.depth) {}

  ExactStep from(const State& before) const {
    ExactStep step{before, std::vector<bool>(static_cast<std::size_t>(m_.grid.cells()), false)};
    State& s = step.state;
    if (m_.flow) push(before, s);
    if (m_.hasTemperature()) {
      const Values& old = before.at(Field::Temperature);
      Values t = old;
      if (m_.diffusion) t = diffused(t);
      if (m_.flow) convect(before, s, t);
      if (m_.buoyancy) t = risen(t);
      if (m_.latentHeat) t = exchanged(old, t, step.doubtful);
      s[Field::Temperature] = t;
    }
    if (m_.reaction) react(before, s);
    return step;
  }

 private:
  std::size_t at(std::int64_t x, std::int64_t y, std::int64_t z = 0) const {
    const auto wrap = [](std::int64_t i, std::int64_t n) { return (i % n + n) % n; };
    return static_cast<std::size_t>((wrap(z, nz_) * ny_ + wrap(y, ny_)) * nx_ + wrap(x, nx_));
  }

  template <class Body>
  Values map(const Body& body) const {
    Values result(static_cast<std::size_t>(m_.grid.cells()));
    for (std::int64_t z = 0; z < nz_; ++z)
      for (std::int64_t y = 0; y < ny_; ++y)
        for (std::int64_t x = 0; x < nx_; ++x) result[at(x, y, z)] = body(x, y, z);
    return result;
  }

  /// The temperature in a cell, or what takes its place outside, seen from (x, y, z), one cell away.
  double warmth(const Values& t, std::int64_t x, std::int64_t y, std::int64_t z, int dx, int dy,
                int dz) const {
    const double here = t[at(x, y, z)];
    const auto outside = [&](Boundary::Side side) {
      const double wall = static_cast<float>(m_.boundary.temperatures[side]);
      return m_.boundary.edges[side] == Edge::Wall ? 2.0 * wall - here : here;
    };
    if (x + dx < 0 && m_.boundary.closedX()) return outside(Boundary::Left);
    if (x + dx >= nx_ && m_.boundary.closedX()) return outside(Boundary::Right);
    if (y + dy < 0 && m_.boundary.closedY()) return outside(Boundary::Bottom);
    if (y + dy >= ny_ && m_.boundary.closedY()) return outside(Boundary::Top);
    if ((z + dz < 0 || z + dz >= nz_) && m_.boundary.closedZ) return here;
    return t[at(x + dx, y + dy, z + dz)];
  }

  Values diffused(const Values& t) const {
    return map([&](std::int64_t x, std::int64_t y, std::int64_t z) {
      const double here = t[at(x, y, z)];
      double lap = warmth(t, x, y, z, -1, 0, 0) + warmth(t, x, y, z, 1, 0, 0) + warmth(t, x, y, z, 0, -1, 0) +
                   warmth(t, x, y, z, 0, 1, 0) - 4.0 * here;
      if (m_.grid.isSpace()) lap += warmth(t, x, y, z, 0, 0, -1) + warmth(t, x, y, z, 0, 0, 1) - 2.0 * here;
      return here + c_.spread * lap;
    });
  }

  Values risen(const Values& t) const {
    const auto density = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      if (m_.boundary.closedY()) y = std::clamp<std::int64_t>(y, 0, ny_ - 1);
      return std::tanh(c_.alpha * (t[at(x, y, z)] - c_.point));
    };
    return map([&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return t[at(x, y, z)] * (1.0 - 0.5 * c_.sigma * (density(x, y + 1, z) - density(x, y - 1, z)));
    });
  }

  /// Does what happens, cell by cell, unlike the kernel, which asks what its neighbours did.
  Values exchanged(const Values& before, const Values& after, std::vector<bool>& doubtful) const {
    const double near = 16 * roundoffOf(m_.precision);
    Values result = after;
    const auto each = [&](std::int64_t x, std::int64_t y, std::int64_t z, const auto& visit) {
      if (x > 0 || !m_.boundary.closedX()) visit(at(x - 1, y, z));
      if (x + 1 < nx_ || !m_.boundary.closedX()) visit(at(x + 1, y, z));
      if (y > 0 || !m_.boundary.closedY()) visit(at(x, y - 1, z));
      if (y + 1 < ny_ || !m_.boundary.closedY()) visit(at(x, y + 1, z));
      if (!m_.grid.isSpace()) return;
      if (z > 0 || !m_.boundary.closedZ) visit(at(x, y, z - 1));
      if (z + 1 < nz_ || !m_.boundary.closedZ) visit(at(x, y, z + 1));
    };
    map([&](std::int64_t x, std::int64_t y, std::int64_t z) {
      const double was = before[at(x, y, z)], is = after[at(x, y, z)];
      if (std::abs(is - c_.point) <= near * std::max(1.0, std::abs(is)))
        each(x, y, z, [&](std::size_t i) { doubtful[i] = true; });
      const double heat = was <= c_.point && is > c_.point   ? -c_.latent
                          : was > c_.point && is <= c_.point ? c_.latent
                                                             : 0.0;
      each(x, y, z, [&](std::size_t i) { result[i] += heat; });
      return 0.0;
    });
    return result;
  }

  void push(const State& before, State& after) const {
    const Values& vx = before.at(Field::VelocityX);
    const Values& vy = before.at(Field::VelocityY);
    const Values& p = before.at(Field::Pressure);
    const Values& t = before.at(Field::Temperature);
    const bool closedX = m_.boundary.closedX(), closedY = m_.boundary.closedY();
    const double mirrored = m_.flow->slip ? 1.0 : -1.0;
    const auto u = [&](std::int64_t x, std::int64_t y) { return vx[at(x, y)]; };
    const auto v = [&](std::int64_t x, std::int64_t y) { return vy[at(x, y)]; };
    const auto mean = [](double a, double b) { return 0.5 * (a + b); };
    const auto square = [](double a) { return a * a; };
    const auto divergence = [&](std::int64_t x, std::int64_t y) {
      return u(x + 1, y) - u(x, y) + v(x, y + 1) - v(x, y);
    };
    after[Field::VelocityX] = map([&](std::int64_t x, std::int64_t y, std::int64_t) {
      if (closedX && x == 0) return 0.0;
      const double below = closedY && y == 0 ? mirrored * u(x, y) : u(x, y - 1);
      const double above = closedY && y == ny_ - 1 ? mirrored * u(x, y) : u(x, y + 1);
      const double moved = square(mean(u(x, y), u(x + 1, y))) - square(mean(u(x - 1, y), u(x, y))) +
                           mean(u(x, y), u(x, y + 1)) * mean(v(x - 1, y + 1), v(x, y + 1)) -
                           mean(u(x, y - 1), u(x, y)) * mean(v(x - 1, y), v(x, y));
      return u(x, y) - c_.carry * (moved + p[at(x, y)] - p[at(x - 1, y)]) +
             c_.viscosity * (u(x - 1, y) + u(x + 1, y) + below + above - 4.0 * u(x, y)) +
             c_.damping * (divergence(x, y) - divergence(x - 1, y));
    });
    after[Field::VelocityY] = map([&](std::int64_t x, std::int64_t y, std::int64_t) {
      if (closedY && y == 0) return 0.0;
      const double left = closedX && x == 0 ? mirrored * v(x, y) : v(x - 1, y);
      const double right = closedX && x == nx_ - 1 ? mirrored * v(x, y) : v(x + 1, y);
      const double moved = square(mean(v(x, y), v(x, y + 1))) - square(mean(v(x, y - 1), v(x, y))) +
                           mean(v(x, y), v(x + 1, y)) * mean(u(x + 1, y - 1), u(x + 1, y)) -
                           mean(v(x - 1, y), v(x, y)) * mean(u(x, y - 1), u(x, y));
      const double warm = mean(t[at(x, y)], t[at(x, y - 1)]) -
                          (c_.rest + static_cast<double>(c_.slope) * static_cast<double>(y));
      return v(x, y) - c_.carry * (moved + p[at(x, y)] - p[at(x, y - 1)]) +
             c_.viscosity * (left + right + v(x, y - 1) + v(x, y + 1) - 4.0 * v(x, y)) +
             c_.damping * (divergence(x, y) - divergence(x, y - 1)) + c_.lift * warm;
    });
  }

  /// The fluxes of a quantity through the faces of a cell, at the velocities of `s`: what comes in less what goes out.
  template <class Look>
  double flux(const State& s, std::int64_t x, std::int64_t y, const Look& look) const {
    const Values& vx = s.at(Field::VelocityX);
    const Values& vy = s.at(Field::VelocityY);
    const double here = look(0, 0);
    return vx[at(x, y)] * (look(-1, 0) + here) - vx[at(x + 1, y)] * (here + look(1, 0)) +
           vy[at(x, y)] * (look(0, -1) + here) - vy[at(x, y + 1)] * (here + look(0, 1));
  }

  void convect(const State& before, State& after, Values& t) const {
    const Values& old = before.at(Field::Temperature);
    const Values& vx = after.at(Field::VelocityX);
    const Values& vy = after.at(Field::VelocityY);
    for (std::int64_t y = 0; y < ny_; ++y) {
      for (std::int64_t x = 0; x < nx_; ++x) {
        t[at(x, y)] += 0.5 * c_.carry * flux(after, x, y, [&](int dx, int dy) {
                         return dx == 0 && dy == 0 ? old[at(x, y)] : warmth(old, x, y, 0, dx, dy, 0);
                       });
        after[Field::Pressure][at(x, y)] -=
            c_.stiffness * (vx[at(x + 1, y)] - vx[at(x, y)] + vy[at(x, y + 1)] - vy[at(x, y)]);
      }
    }
  }

  void react(const State& before, State& after) const {
    const Values& u = before.at(Field::U);
    const Values& v = before.at(Field::V);
    const auto look = [&](const Values& a, std::int64_t x, std::int64_t y, int dx, int dy) {
      const bool offX = m_.boundary.closedX() && (x + dx < 0 || x + dx >= nx_);
      const bool offY = m_.boundary.closedY() && (y + dy < 0 || y + dy >= ny_);
      return offX || offY ? a[at(x, y)] : a[at(x + dx, y + dy)];
    };
    const auto spread = [&](const Values& a, std::int64_t x, std::int64_t y) {
      return look(a, x, y, -1, 0) + look(a, x, y, 1, 0) + look(a, x, y, 0, -1) + look(a, x, y, 0, 1) -
             4.0 * a[at(x, y)];
    };
    const auto stirred = [&](const Values& a, std::int64_t x, std::int64_t y) {
      if (!m_.flow) return 0.0;
      return c_.stirring * flux(after, x, y, [&](int dx, int dy) { return a[at(x + dx, y + dy)]; });
    };
    const double feed = c_.feed, kill = c_.kill, dt = c_.reactionStep;
    after[Field::U] = map([&](std::int64_t x, std::int64_t y, std::int64_t) {
      const double a = u[at(x, y)], b = v[at(x, y)];
      return a + c_.spreadU * spread(u, x, y) + dt * (feed * (1.0 - a) - a * b * b) + stirred(u, x, y);
    });
    after[Field::V] = map([&](std::int64_t x, std::int64_t y, std::int64_t) {
      const double a = u[at(x, y)], b = v[at(x, y)];
      return b + c_.spreadV * spread(v, x, y) + dt * (a * b * b - (feed + kill) * b) + stirred(v, x, y);
    });
  }

  Model m_;
  Coefficients c_;
  std::int64_t nx_, ny_, nz_;
};

double largestOf(const Values& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

State readState(Lattice& lattice) {
  State state;
  for (const Field field : fieldsOf(lattice.model())) state[field] = lattice.read(field);
  return state;
}

ExactStep stepExactly(const Model& model, const State& state) { return HostStep(model).from(state); }

Verification checkStep(const Model& model, const State& before, const State& after, double tableError) {
  const ExactStep exact = stepExactly(model, before);
  const Coefficients c = coefficientsOf(model);
  const double rounding = 32.0 * roundoffOf(model.precision);
  double table = 0.0;
  if (model.buoyancy) table = c.sigma * tableError * largestOf(before.at(Field::Temperature));
  Verification verification(fmt::format("one step against double loops, {} fields", after.size()),
                            rounding + table,
                            table > 0.0 ? "32 roundings of the largest number, and the table of tanh"
                                        : "32 roundings of the largest number");
  // Velocities are sums of pressures and of what lifts, pressures sums of velocities: each has the others' roundings.
  double velocity = 0.0, pressure = 0.0;
  if (model.flow) {
    velocity = std::max({largestOf(before.at(Field::VelocityX)), largestOf(before.at(Field::VelocityY)),
                         static_cast<double>(c.carry) * largestOf(before.at(Field::Pressure)),
                         static_cast<double>(c.lift) * largestOf(before.at(Field::Temperature))});
    pressure = static_cast<double>(c.stiffness) * velocity;
  }
  for (const auto& [field, values] : after) {
    const std::vector<double>& expected = exact.state.at(field);
    double scale = std::max(largestOf(expected), largestOf(before.at(field)));
    if (field == Field::VelocityX || field == Field::VelocityY) scale = std::max(scale, velocity);
    if (field == Field::Pressure) scale = std::max(scale, pressure);
    if (scale == 0.0) scale = 1.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (field == Field::Temperature && exact.doubtful[i]) continue;
      verification.compare(static_cast<std::int64_t>(i), values[i], expected[i], scale);
    }
  }
  return verification;
}

}  // namespace examples
