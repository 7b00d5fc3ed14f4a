// SPDX-License-Identifier: MIT
#include "model.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fluid {

namespace {

using Place = std::array<std::int64_t, 3>;

Place extents(const Model& m) {
  Place n{};
  for (int d = 0; d < 3; ++d)
    n[static_cast<std::size_t>(d)] = m.cells[static_cast<std::size_t>(d)] + (m.isPeriodic(d) ? 0 : 2);
  return n;
}

template <class Visit>
void visitCells(const Model& m, Visit&& visit) {
  const Place n = extents(m);
  std::size_t i = 0;
  for (std::int64_t z = 0; z < n[2]; ++z)
    for (std::int64_t y = 0; y < n[1]; ++y)
      for (std::int64_t x = 0; x < n[0]; ++x, ++i) visit(i, Place{x, y, z});
}

/// The side whose layer a cell belongs to; -1 inside. Of two, the one of the later axis, as kernels have it.
int sideAt(const Model& m, const Place& at) {
  int side = -1;
  for (int d = 0; d < 3; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    if (m.isPeriodic(d)) continue;
    if (at[axis] < 1) side = 2 * d;
    if (at[axis] > m.cells[axis]) side = 2 * d + 1;
  }
  return side;
}

Place wrapped(Place at, const Place& n) {
  for (std::size_t d = 0; d < 3; ++d) at[d] = (at[d] + n[d]) % n[d];
  return at;
}

/// Parts of the fluid that are connected through faces, filled one after the other.
class Parts {
 public:
  explicit Parts(const Model& m) : m_(m), n_(extents(m)), cells_(cellsOf(m)), seen_(cells_.size(), false) {}

  std::string contradiction() {
    std::string found;
    visitCells(m_, [&](std::size_t i, const Place& at) {
      if (!found.empty() || cells_[i] != Fluid || seen_[i]) return;
      found = fill(at);
    });
    return found;
  }

 private:
  std::string fill(const Place& start) {
    std::vector<Place> open{start};
    seen_[static_cast<std::size_t>(m_.index(start))] = true;
    double inflow = 0.0, magnitudes = 0.0;
    bool hasOutflow = false;
    int through = -1;
    while (!open.empty()) {
      const Place at = open.back();
      open.pop_back();
      for (int d = 0; d < m_.rank(); ++d) {
        for (const int sign : {-1, 1}) {
          Place next = at;
          next[static_cast<std::size_t>(d)] += sign;
          next = wrapped(next, n_);
          const auto i = static_cast<std::size_t>(m_.index(next));
          if (cells_[i] == Fluid && !seen_[i]) {
            seen_[i] = true;
            open.push_back(next);
          }
          if (cells_[i] == Outflow) hasOutflow = true;
          const int side = sideAt(m_, next);
          if (cells_[i] != Solid || side < 0) continue;
          const double speed =
              -sign * m_.sideVelocity[static_cast<std::size_t>(side)][static_cast<std::size_t>(d)];
          inflow += speed;
          magnitudes += std::abs(speed);
          if (speed != 0.0) through = side;
        }
      }
    }
    if (hasOutflow || std::abs(inflow) <= 1e-9 * magnitudes) return "";
    return fmt::format(
        "is incompatible: more flows {} through '{}' than through the other sides, and what is "
        "incompressible "
        "has no place for it; make one of the sides \"outflow\"",
        inflow > 0.0 ? "in" : "out", sideNames[static_cast<std::size_t>(through)]);
  }

  const Model& m_;
  Place n_;
  std::vector<std::int8_t> cells_;
  std::vector<bool> seen_;
};

}  // namespace

double Shape::distance(const Triple& p, bool isSpace) const {
  const std::size_t rank = isSpace ? 3 : 2;
  if (sphere) {
    double squared = 0.0;
    for (std::size_t d = 0; d < rank; ++d) squared += (p[d] - sphere->centre[d]) * (p[d] - sphere->centre[d]);
    return std::sqrt(squared) - sphere->radius;
  }
  double outside = 0.0, inside = -1e300;
  for (std::size_t d = 0; d < rank; ++d) {
    const double beyond = std::max(brick->low[d] - p[d], p[d] - brick->high[d]);
    outside += std::max(beyond, 0.0) * std::max(beyond, 0.0);
    inside = std::max(inside, beyond);
  }
  return inside > 0.0 ? std::sqrt(outside) : inside;
}

sk::Shape Model::shape() const {
  const Place n = extents(*this);
  return {n[2], n[1], n[0]};
}

Triple Model::centre(const Place& at) const {
  Triple p{};
  for (int d = 0; d < 3; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    p[axis] = (static_cast<double>(at[axis]) + (isPeriodic(d) ? 0.5 : -0.5)) * spacing;
  }
  return p;
}

std::int64_t Model::index(const Place& at) const {
  const Place n = extents(*this);
  return at[0] + n[0] * (at[1] + n[1] * at[2]);
}

bool Model::isMasked(const Place& at) const {
  if (mask.empty()) return false;
  Place inner{};
  for (std::size_t d = 0; d < 3; ++d) {
    inner[d] = d < static_cast<std::size_t>(rank()) ? at[d] - 1 : 0;
    if (inner[d] < 0 || inner[d] >= cells[d]) return false;
  }
  return mask[static_cast<std::size_t>(inner[0] + cells[0] * (inner[1] + cells[1] * inner[2]))];
}

Bounds Model::bounds() const {
  if (hasObstacles()) return Anywhere;
  for (int d = 0; d < rank(); ++d)
    if (!isPeriodic(d)) return Around;
  return Nowhere;
}

Cell cellOf(Side side) {
  switch (side) {
    case Side::Periodic: return Fluid;
    case Side::Wall:
    case Side::Inflow: return Solid;
    case Side::Slip: return Slip;
    case Side::Outflow: return Outflow;
  }
  return Solid;
}

std::string sizeText(const Model& m) {
  return m.isSpace() ? fmt::format("{} x {} x {}", m.cells[0], m.cells[1], m.cells[2])
                     : fmt::format("{} x {}", m.cells[0], m.cells[1]);
}

std::string operatorsOf(const Model& m) {
  constexpr std::array<const char*, 4> schemes = {"semi-Lagrangian", "MacCormack", "BFECC",
                                                  "central differences"};
  std::string text = fmt::format("projection, convection by {}", schemes[static_cast<std::size_t>(m.scheme)]);
  if (m.viscosity) text += m.viscosity->isImplicit ? ", implicit viscosity" : ", viscosity";
  if (m.bounds() == Around) text += ", sides";
  if (m.bounds() == Anywhere) text += ", obstacles";
  if (m.hasSmoke) text += ", smoke";
  if (m.hasHeat) text += ", heat";
  if (m.buoyancy) text += ", buoyancy";
  if (!m.sources.empty()) text += ", sources";
  return text;
}

std::vector<std::int8_t> cellsOf(const Model& m) {
  const sk::Shape shape = m.shape();
  std::vector<std::int8_t> cells(static_cast<std::size_t>(shape.size()), Fluid);
  visitCells(m, [&](std::size_t i, const Place& at) {
    const int side = sideAt(m, at);
    if (side >= 0) {
      cells[i] = static_cast<std::int8_t>(cellOf(m.sides[static_cast<std::size_t>(side)]));
      return;
    }
    const Triple p = m.centre(at);
    for (const Shape& obstacle : m.obstacles)
      if (obstacle.distance(p, m.isSpace()) < 0.0) cells[i] = m.obstaclesSlip ? Slip : Solid;
    if (m.isMasked(at)) cells[i] = m.obstaclesSlip ? Slip : Solid;
  });
  return cells;
}

std::vector<double> coverageOf(const Model& m) {
  std::vector<double> covered(static_cast<std::size_t>(m.shape().size()), 0.0);
  visitCells(m, [&](std::size_t i, const Place& at) {
    const Triple p = m.centre(at);
    if (m.isMasked(at)) covered[i] = 1.0;
    for (const Shape& obstacle : m.obstacles) {
      const double depth = 0.5 - obstacle.distance(p, m.isSpace()) / (3.0 * m.spacing);
      covered[i] = std::max(covered[i], std::clamp(depth, 0.0, 1.0));
    }
  });
  return covered;
}

std::string contradiction(const Model& model) {
  const std::vector<std::int8_t> cells = cellsOf(model);
  if (fluidCells(cells) == 0) return "leave no fluid: they fill every cell of the grid; make them smaller";
  return Parts(model).contradiction();
}

std::int64_t fluidCells(const std::vector<std::int8_t>& cells) { return std::ranges::count(cells, Fluid); }

std::vector<double> givenVelocity(const Model& m, int axis, const Triple& inside) {
  const std::vector<std::int8_t> cells = cellsOf(m);
  const Place n = extents(m);
  const auto a = static_cast<std::size_t>(axis);
  std::vector<double> velocity(cells.size(), 0.0);
  visitCells(m, [&](std::size_t i, const Place& at) {
    Place below = at;
    --below[a];
    below = wrapped(below, n);
    const auto lower = static_cast<std::size_t>(m.index(below));
    const auto isOpen = [&](std::size_t k) { return cells[k] == Fluid || cells[k] == Outflow; };
    if (isOpen(i) && isOpen(lower)) {
      velocity[i] = inside[a];
      return;
    }
    // A side's own velocity at its faces, and in the layer behind it. Where two sides meet, that of the cell's own.
    const int side = std::max(sideAt(m, at), cells[i] == Fluid ? sideAt(m, below) : -1);
    if (side >= 0) velocity[i] = m.sideVelocity[static_cast<std::size_t>(side)][a];
  });
  return velocity;
}

}  // namespace fluid
